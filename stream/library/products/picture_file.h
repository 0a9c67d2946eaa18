#pragma once

#include <spillway/picture.h>

#include <cstdint>
#include <memory>
#include <string>

#include "formats/disk/scratch_folder.h"
#include "stream/library/meshes/engine_sink.h"
#include "stream/library/products/picture_check.h"
#include "stream/sinks/scene.h"

namespace spillway::stream {

/// A picture of a mesh in the making: a PNG, or a GeoTIFF.
class PictureFile final : public OwnSink<PictureSink> {
 public:
  PictureFile(const std::string& path, const PictureOptions& options, const Context& context);

  void identify(RunIdentity& identity) const override {
    identify_product("picture", path_, identity);
  }
  [[nodiscard]] const PictureReport& report() const override { return report_; }

  [[nodiscard]] CrsNeed crs_need() const override;
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
  /// Draws what goes below the picture, whose rows are those of the scene so far.
  void add_words(Picture& picture) const;
  std::uint64_t write_as_png(const Picture& picture);
  std::uint64_t write_as_geotiff(const Picture& picture);

  std::string path_;
  PictureOptions options_;
  std::shared_ptr<ScratchFolder> scratch_;
  const bool is_geotiff_;
  int dimension_ = 2;
  std::string crs_;
  SceneMesh mesh_;
  std::unique_ptr<Scene> scene_;
  PictureReport report_;
};

}  // namespace spillway::stream
