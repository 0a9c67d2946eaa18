#pragma once

#include <spillway/picture.h>

#include <cstdint>
#include <memory>
#include <string>

#include "formats/disk/scratch_folder.h"
#include "stream/library/meshes/engine_sink.h"
#include "stream/sinks/scene.h"

namespace spillway::stream {

/// A PNG file of a mesh in the making.
class PictureFile final : public OwnSink<PictureSink> {
 public:
  PictureFile(const std::string& path, const PictureOptions& options, const Context& context);

  void identify(RunIdentity& identity) const override {
    identify_product("picture", path_, identity);
  }
  [[nodiscard]] const PictureReport& report() const override { return report_; }

  [[nodiscard]] std::uint64_t own_memory(std::uint64_t limit) const override;
  [[nodiscard]] unsigned feeding_threads(unsigned threads) const override;
  [[nodiscard]] bool wants_extent() const override { return !options_.zoom; }
  void extent_known(const Box<2>& extent, std::uint64_t vertices) override;
  BlockSink* begin_again() override;
  void finalize(RunWatch& watch, Report& report, OtherShares& others) override;

 private:
  BlockSink& open(const MeshStart& start) override;

  std::string path_;
  PictureOptions options_;
  std::shared_ptr<ScratchFolder> scratch_;
  int dimension_ = 2;
  SceneMesh mesh_;
  std::unique_ptr<Scene> scene_;
  PictureReport report_;
};

}  // namespace spillway::stream
