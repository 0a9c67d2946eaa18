#pragma once

#include <spillway/picture.h>

#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "formats/disk/scratch_folder.h"
#include "stream/library/meshes/engine_sink.h"
#include "stream/library/products/picture_check.h"
#include "stream/sinks/relief_samples.h"

namespace spillway::stream {

/// A page of a terrain in the making: a grid of heights, which a browser shows in three dimensions.
class PageFile final : public OwnSink<PictureSink> {
 public:
  PageFile(const std::string& path, const PictureOptions& options, const Context& context);

  void identify(RunIdentity& identity) const override { identify_product("page", path_, identity); }
  [[nodiscard]] const PictureReport& report() const override { return report_; }

  [[nodiscard]] AttributeChoice wanted_attributes(bool /*triangulated*/) const override {
    return {.names = attributes_of(options_.colour)};
  }
  void check_attributes(const AttributeLayout& there) const override {
    check_picture_attributes(options_, there);
  }
  [[nodiscard]] std::uint64_t own_memory(std::uint64_t limit) const override;
  [[nodiscard]] unsigned feeding_threads(unsigned threads) const override;
  [[nodiscard]] bool wants_extent() const override { return !options_.zoom; }
  void extent_known(const Box<2>& extent, std::uint64_t vertices) override;
  BlockSink* begin_again() override;
  void finalize(RunWatch& watch, Report& report, OtherShares& others) override;

 private:
  BlockSink& open(const MeshStart& start) override;
  void lay_grid(const Box<2>& extent);
  std::uint64_t write(const HeightPixels& heights, const Report& report);

  std::string path_;
  PictureOptions options_;
  std::uint64_t most_triangles_;
  std::shared_ptr<ScratchFolder> scratch_;
  SceneMesh mesh_;
  std::optional<ReliefSamples> samples_;
  PictureReport report_;
};

}  // namespace spillway::stream
