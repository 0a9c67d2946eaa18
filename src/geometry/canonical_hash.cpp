#include "src/geometry/canonical_hash.h"

// Inlined: a call into the library costs as much as the hash of so few bytes.
#define XXH_INLINE_ALL
#include <xxhash.h>

#include <bit>
#include <utility>

namespace spillway {

static_assert(std::endian::native == std::endian::little,
              "the canonical hash is defined on little-endian doubles");

template <int D>
requires SupportedDimension<D>
void CanonicalHash<D>::add(std::array<Point<D>, D + 1> simplex) {
  for (auto& vertex : simplex) {
    for (double& coordinate : vertex) coordinate += 0.0;  // turns -0.0 into +0.0
  }
  for (int i = 1; i <= D; ++i) {  // insertion, the fastest for so few
    for (int j = i; j > 0 && simplex[j] < simplex[j - 1]; --j) {
      std::swap(simplex[j], simplex[j - 1]);
    }
  }
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
