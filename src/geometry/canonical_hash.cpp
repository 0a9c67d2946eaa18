#include "src/geometry/canonical_hash.h"

// Inlined: a call into the library costs as much as the hash of so few bytes.
#define XXH_INLINE_ALL
#include <xxhash.h>

#include <bit>

#include "src/geometry/dimensions.h"

namespace spillway::geometry {
namespace {

static_assert(std::endian::native == std::endian::little,
              "the canonical hash is defined on little-endian numbers");

}  // namespace

template <int D>
std::uint64_t vertex_hash(Point<D> position) {
  for (double& coordinate : position) coordinate += 0.0;  // turns -0.0 into +0.0
  return XXH3_64bits(position.data(), sizeof position);
}

template <int D>
requires Dimension<D>
void CanonicalHash<D>::add(const std::array<Point<D>, D + 1>& simplex) {
  std::uint64_t vertices = 0;
  for (const Point<D>& position : simplex) vertices += vertex_hash<D>(position);
  add(vertices);
}

template <int D>
requires Dimension<D>
void CanonicalHash<D>::add(std::span<const std::uint32_t> corners,
                           std::span<const std::uint64_t> vertices) {
  for (std::size_t s = 0; s < corners.size(); s += D + 1) {
    std::uint64_t sum = 0;
    for (int i = 0; i <= D; ++i) sum += vertices[corners[s + i]];
    add(sum);
  }
}

std::string hash_to_hex(std::uint64_t hash) {
  std::string hex(16, '0');
  for (auto digit = hex.rbegin(); digit != hex.rend(); ++digit, hash >>= 4) {
    *digit = "0123456789abcdef"[hash & 15];
  }
  return hex;
}

#define SPILLWAY_INSTANTIATE(D)                    \
  template std::uint64_t vertex_hash<D>(Point<D>); \
  template class CanonicalHash<D>;
SPILLWAY_FOR_EACH_DIMENSION(SPILLWAY_INSTANTIATE)
#undef SPILLWAY_INSTANTIATE

}  // namespace spillway::geometry
