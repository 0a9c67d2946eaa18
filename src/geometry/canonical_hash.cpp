#include "src/geometry/canonical_hash.h"

#include <xxhash.h>

#include <algorithm>
#include <bit>

namespace spillway {

static_assert(std::endian::native == std::endian::little,
              "the canonical hash is defined on little-endian doubles");

template <int D>
requires SupportedDimension<D>
void CanonicalHash<D>::add(std::array<Point<D>, D + 1> simplex) {
  for (auto& vertex : simplex) {
    for (double& coordinate : vertex) coordinate += 0.0;  // turns -0.0 into +0.0
  }
  std::sort(simplex.begin(), simplex.end());
  sum_ += XXH3_64bits(simplex.data(), sizeof(simplex));
}

std::string hash_to_hex(std::uint64_t hash) {
  std::string hex(16, '0');
  for (auto digit = hex.rbegin(); digit != hex.rend(); ++digit, hash >>= 4) {
    *digit = "0123456789abcdef"[hash & 15];
  }
  return hex;
}

template class CanonicalHash<2>;
template class CanonicalHash<3>;

}  // namespace spillway
