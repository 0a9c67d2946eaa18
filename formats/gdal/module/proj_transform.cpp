#include "formats/gdal/module/proj_transform.h"

#include <fmt/format.h>
#include <ogr_spatialref.h>

#include <limits>
#include <utility>
#include <vector>

#include "formats/gdal/module/crs.h"
#include "formats/gdal/module/gdal_errors.h"
#include "src/error.h"

namespace spillway::formats {
namespace {

class ProjTransform final : public CrsTransform {
 public:
  explicit ProjTransform(std::unique_ptr<OGRCoordinateTransformation> transform)
      : transform_(std::move(transform)) {}

  void apply(std::span<double> x, std::span<double> y, std::span<double> z) override {
    succeeded_.assign(x.size(), FALSE);
    // What it returns says that all have succeeded, which the flags say of each.
    transform_->Transform(static_cast<int>(x.size()), x.data(), y.data(), z.data(),
                          succeeded_.data());
    for (std::size_t i = 0; i < x.size(); ++i) {
      if (succeeded_[i] == FALSE) x[i] = y[i] = std::numeric_limits<double>::infinity();
    }
    forget_gdal_errors();
  }

 private:
  std::unique_ptr<OGRCoordinateTransformation> transform_;
  std::vector<int> succeeded_;
};

}  // namespace

std::unique_ptr<CrsTransform> create_proj_transform(const std::string& from,
                                                    const std::string& to) {
  const OGRSpatialReference source = parse_crs(from);
  const OGRSpatialReference target = parse_crs(to);
  forget_gdal_errors();
  OGRCoordinateTransformationOptions options;
  // A guess that takes one datum for another may be hundreds of metres off.
  options.SetBallparkAllowed(false);
  std::unique_ptr<OGRCoordinateTransformation> transform(
      OGRCreateCoordinateTransformation(&source, &target, options));
  if (!transform) {
    throw Failure(fmt::format("PROJ knows no way from the coordinate system {} to {}: {}",
                              crs_name(from), crs_name(to), gdal_reason()),
                  ErrorCode::kBadInput);
  }
  return std::make_unique<ProjTransform>(std::move(transform));
}

}  // namespace spillway::formats
