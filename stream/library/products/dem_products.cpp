// The products of a DEM: their names, and what each depends on.

#include <spillway/dem.h>

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <system_error>

namespace spillway {

const std::vector<std::string>& dem_product_names() {
  static const std::vector<std::string> names = {"height",
                                                 "slope",
                                                 "aspect",
                                                 "hillshade",
                                                 "multi-hillshade",
                                                 "roughness",
                                                 "tri",
                                                 "tpi",
                                                 "curvature",
                                                 "profile-curvature",
                                                 "plan-curvature",
                                                 "facet-slope",
                                                 "facet-aspect",
                                                 "facet-hillshade",
                                                 "density",
                                                 "min",
                                                 "max",
                                                 "mean",
                                                 "count",
                                                 "stddev",
                                                 "percentile"};
  return names;
}

std::optional<DemBand> dem_band_of(const std::string& name) {
  const std::vector<std::string>& names = dem_product_names();
  const auto found = std::ranges::find(names, name);
  if (found != names.end() && *found != names.back()) {
    return DemBand{static_cast<DemProduct>(found - names.begin())};
  }
  if (name.size() < 2 || name.front() != 'p') return std::nullopt;
  double percent = 0;
  const char* const end = name.data() + name.size();
  const auto [read, error] = std::from_chars(name.data() + 1, end, percent);
  const bool is_one = error == std::errc() && read == end && percent >= 0 && percent <= 100;
  if (!is_one) return std::nullopt;
  return DemBand{DemProduct::kPercentile, percent + 0.0};
}

std::string name_of(const DemBand& band) {
  if (band.product == DemProduct::kPercentile) return fmt::format("p{}", band.percentile);
  return dem_product_names()[static_cast<std::size_t>(band.product)];
}

DemProductTraits traits_of(DemProduct product) {
  switch (product) {
    case DemProduct::kSlope:
    case DemProduct::kAspect:
      return {.of_neighbours = true, .by_gradient = true, .by_ground = true};
    case DemProduct::kHillshade:
      return {.of_neighbours = true,
              .by_gradient = true,
              .by_ground = true,
              .by_azimuth = true,
              .by_altitude = true};
    case DemProduct::kMultiHillshade:
      return {.of_neighbours = true, .by_gradient = true, .by_ground = true, .by_altitude = true};
    case DemProduct::kRoughness:
    case DemProduct::kTri:
    case DemProduct::kTpi:
      return {.of_neighbours = true};
    case DemProduct::kCurvature:
    case DemProduct::kProfileCurvature:
    case DemProduct::kPlanCurvature:
      return {.of_neighbours = true, .by_ground = true};
    case DemProduct::kFacetSlope:
    case DemProduct::kFacetAspect:
      return {.by_ground = true};
    case DemProduct::kFacetHillshade:
      return {.by_ground = true, .by_azimuth = true, .by_altitude = true};
    case DemProduct::kMin:
    case DemProduct::kMax:
    case DemProduct::kMean:
    case DemProduct::kPercentile:
      return {.of_points = true, .fills_voids = true};
    case DemProduct::kCount:
    case DemProduct::kStddev:
      return {.of_points = true};
    case DemProduct::kHeight:
    case DemProduct::kDensity:
      break;
  }
  return {};
}

}  // namespace spillway
