#include "tools/commands/facet_count.h"

#include <algorithm>
#include <array>
#include <vector>

namespace spillway::detail {
namespace {

/// `corners` is the number of vertices of a facet.
template <std::size_t Corners>
std::uint64_t count_single(const Mesh& mesh) {
  using Facet = std::array<std::uint64_t, Corners>;
  std::vector<Facet> facets;
  facets.reserve(mesh.corners.size());
  for (std::size_t simplex = 0; simplex < mesh.corners.size(); simplex += Corners + 1) {
    for (std::size_t opposite = 0; opposite <= Corners; ++opposite) {
      Facet facet{};
      auto place = facet.begin();
      for (std::size_t i = 0; i <= Corners; ++i) {
        if (i != opposite) *place++ = mesh.corners[simplex + i];
      }
      std::sort(facet.begin(), facet.end());
      facets.push_back(facet);
    }
  }
  std::sort(facets.begin(), facets.end());
  std::uint64_t single = 0;
  for (auto facet = facets.begin(); facet != facets.end();) {
    const auto next =
        std::find_if(facet, facets.end(), [&](const Facet& f) { return f != *facet; });
    if (next - facet == 1) ++single;
    facet = next;
  }
  return single;
}

}  // namespace

std::uint64_t count_boundary_facets(const Mesh& mesh) {
  return mesh.header.dimension == 2 ? count_single<2>(mesh) : count_single<3>(mesh);
}

}  // namespace spillway::detail
