#include "stream/library/products/surface_units.h"

#include <fmt/format.h>

#include <cmath>

#include "src/error.h"

namespace spillway::stream {

void check_z_factor(const std::optional<double>& factor) {
  if (!factor || (*factor > 0 && std::isfinite(*factor))) return;
  throw InvalidArgument(
      fmt::format("heights are multiplied by a number above 0, not by {}", *factor));
}

double z_factor_by(const CrsUnits& units) {
  constexpr double kRounding = 1e-9;  // the two feet differ by 2e-6
  const double factor = units.vertical / units.horizontal;
  const bool is_told = factor > 0 && std::isfinite(factor) && std::abs(factor - 1) > kRounding;
  return is_told ? factor : 1;
}

void check_same_crs(const std::string& name, const std::string& crs, const std::string& other,
                    const std::string& other_crs, const std::string& file) {
  if (crs.empty() || other_crs.empty() || crs == other_crs || gdal().same_crs(crs, other_crs)) {
    return;
  }
  throw Failure(fmt::format("{} is in {}, but {} in {}; reproject one of them, or take coordinates "
                            "as they are",
                            name, gdal().crs_name(crs), other, gdal().crs_name(other_crs)),
                ErrorCode::kBadInput, {.file = file, .remedy = Remedy::kForeignCrs});
}

}  // namespace spillway::stream
