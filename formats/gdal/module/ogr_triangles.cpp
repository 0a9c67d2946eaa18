// Layers of triangles that are read.

#include <fmt/format.h>
#include <ogrsf_frmts.h>

#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "formats/gdal/module/crs.h"
#include "formats/gdal/module/gdal_errors.h"
#include "formats/gdal/vector_drivers.h"
#include "src/error.h"

namespace spillway::formats {
namespace {

WorldPoint point_of(const OGRLineString& line, int i) {
  return {line.getX(i), line.getY(i), line.Is3D() != 0 ? line.getZ(i) : 0.0};
}

bool is_clockwise(const std::array<WorldPoint, 3>& p) {
  return (p[1][0] - p[0][0]) * (p[2][1] - p[0][1]) < (p[1][1] - p[0][1]) * (p[2][0] - p[0][0]);
}

class OgrTriangles : public TriangleLayer {
 public:
  explicit OgrTriangles(std::string path) : path_(std::move(path)) {
    forget_gdal_errors();
    constexpr unsigned kHow = GDAL_OF_VECTOR | GDAL_OF_READONLY | GDAL_OF_VERBOSE_ERROR;
    const std::array<const char*, 3> drivers = {"GPKG", "ESRI Shapefile", nullptr};
    file_.reset(GDALDataset::Open(path_.c_str(), kHow, drivers.data(), nullptr, nullptr));
    if (!file_) fail(gdal_reason());
    if (file_->GetLayerCount() != 1) {
      fail(fmt::format("it has {} layers, but a mesh is one; copy its layer to a file of its own",
                       file_->GetLayerCount()));
    }
    layer_ = file_->GetLayer(0);
    layer_->ResetReading();
  }

  [[nodiscard]] std::string crs() const override { return wkt_of_layer(layer_->GetSpatialRef()); }

  [[nodiscard]] std::string metadata(const std::string& name) const override {
    const char* const text = layer_->GetMetadataItem(name.c_str());
    return text == nullptr ? "" : text;
  }

  bool next(std::array<WorldPoint, 3>& corners) override {
    while (true) {
      if (waiting_.empty() && !read_feature()) return false;
      const OGRGeometry& geometry = *waiting_.back();
      waiting_.pop_back();
      if (unpack(geometry)) continue;
      corners = corners_of(geometry);
      return true;
    }
  }

 private:
  /// Puts the geometry of the next feature into waiting_; false at the end.
  bool read_feature() {
    forget_gdal_errors();
    feature_.reset(layer_->GetNextFeature());
    if (gdal_failed()) fail(gdal_reason());
    if (!feature_) return false;
    const OGRGeometry* const geometry = feature_->GetGeometryRef();
    if (geometry == nullptr) fail_for_feature("it has no geometry");
    waiting_.push_back(geometry);
    return true;
  }

  template <typename Collection>
  bool unpack_parts(const OGRGeometry& geometry) {
    const auto* const parts = dynamic_cast<const Collection*>(&geometry);
    if (parts == nullptr) return false;
    for (int i = parts->getNumGeometries(); i-- > 0;) {
      waiting_.push_back(parts->getGeometryRef(i));
    }
    return true;
  }

  /// Puts the parts of a geometry into waiting_; false if it is none of parts.
  bool unpack(const OGRGeometry& geometry) {
    return unpack_parts<OGRPolyhedralSurface>(geometry) ||
           unpack_parts<OGRGeometryCollection>(geometry);
  }

  [[nodiscard]] std::array<WorldPoint, 3> corners_of(const OGRGeometry& geometry) const {
    const auto* const polygon = dynamic_cast<const OGRPolygon*>(&geometry);
    if (polygon == nullptr) {
      fail_for_feature(
          fmt::format("it is a {}, and only triangles are read", geometry.getGeometryName()));
    }
    const OGRLinearRing* const ring = polygon->getExteriorRing();
    if (ring == nullptr || polygon->getNumInteriorRings() > 0 || ring->getNumPoints() != 4) {
      fail_for_feature("it is a polygon, but not a triangle");
    }
    std::array<WorldPoint, 3> corners;
    for (int i = 0; i < 3; ++i) {
      corners[i] = point_of(*ring, i);
      for (const double coordinate : corners[i]) {
        if (!std::isfinite(coordinate)) fail_for_feature("a coordinate is not finite");
      }
    }
    if (point_of(*ring, 3) != corners[0]) fail_for_feature("its ring is not closed");
    // Shapefiles have rings clockwise.
    if (is_clockwise(corners)) std::swap(corners[1], corners[2]);
    return corners;
  }

  [[noreturn]] void fail_for_feature(const std::string& what) const {
    const auto number = static_cast<std::uint64_t>(feature_->GetFID());
    fail(fmt::format("feature {}: {}", number, what), at_record(number));
  }

  [[noreturn]] void fail(const std::string& what, FilePlace place = {}) const {
    throw Failure(fmt::format("cannot read {}: {}", path_, what), ErrorCode::kBadInput,
                  {.file = path_, .place = place});
  }

  std::string path_;
  GDALDatasetUniquePtr file_;
  OGRLayer* layer_ = nullptr;  // owned by file_
  OGRFeatureUniquePtr feature_;
  std::vector<const OGRGeometry*> waiting_;  // parts of feature_ to be read, the next one last
};

}  // namespace

std::unique_ptr<TriangleLayer> open_ogr_layer(const std::string& path) {
  return std::make_unique<OgrTriangles>(path);
}

}  // namespace spillway::formats
