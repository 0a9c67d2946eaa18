#include "src/generators/generators.h"

#include <algorithm>
#include <array>

#include <fmt/format.h>

#include "src/error.h"
#include "src/generators/families.h"
#include "src/geometry/dimensions.h"

namespace spillway::generators {
namespace {

constexpr std::array<const char*, 16> kNames = {
    "uniform", "normal", "bubbles",  "ellipsoid",  "lines",     "lattice",  "circle", "terrain",
    "packing", "scan",   "clusters", "duplicates", "collinear", "coplanar", "utm", "haloes"};
static_assert(kNames.size() == static_cast<std::size_t>(Family::kHaloes) + 1);

}  // namespace

std::vector<std::string> family_names() { return {kNames.begin(), kNames.end()}; }

Family family_by_name(std::string_view name) {
  const auto found = std::find(kNames.begin(), kNames.end(), name);
  if (found == kNames.end()) {
    throw InvalidArgument(fmt::format("there is no family of points called '{}'; choose one of {}",
                                      name, fmt::join(kNames, ", ")));
  }
  return static_cast<Family>(found - kNames.begin());
}

bool always_has_heights(Family family) {
  return family == Family::kTerrain || family == Family::kScan;
}

std::unique_ptr<PointGenerator> make_generator(const GeneratorOptions& options) {
  if (!is_dimension(options.dimension)) {
    throw InvalidArgument(
        fmt::format("cannot generate points of dimension {}; choose 2 to 6", options.dimension));
  }
  if (options.dimension > 3) {
    return make_higher(options, kNames[static_cast<std::size_t>(options.family)]);
  }
  if (options.family == Family::kTerrain) return make_terrain(options);
  if (options.family == Family::kPacking) return make_packing(options);
  if (options.family == Family::kScan) return make_scan(options);
  auto generator = make_distribution(options);
  return generator ? std::move(generator) : make_degenerate(options);
}

template <int D>
std::vector<Point<D>> generated_points(const GeneratorOptions& options) {
  GeneratorOptions of_dimension = options;
  of_dimension.dimension = D;
  const auto generator = make_generator(of_dimension);
  std::array<Point<3>, 1024> block;
  std::vector<Point<D>> all;
  all.reserve(options.count);
  while (const std::size_t n = generator->next(block)) {
    for (std::size_t i = 0; i < n; ++i) {
      Point<D> p;
      std::copy_n(block[i].begin(), std::min(D, 3), p.begin());
      if constexpr (D > 3) std::copy_n(&generator->further()[i * (D - 3)], D - 3, p.begin() + 3);
      all.push_back(p);
    }
  }
  return all;
}

#define SPILLWAY_INSTANTIATE(D) \
  template std::vector<Point<D>> generated_points<D>(const GeneratorOptions&);
SPILLWAY_FOR_EACH_DIMENSION(SPILLWAY_INSTANTIATE)
#undef SPILLWAY_INSTANTIATE

}  // namespace spillway::generators
