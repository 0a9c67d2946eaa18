#include "src/delaunay/hilbert_order.h"

#include <algorithm>
#include <array>
#include <utility>

namespace spillway {
namespace {

/// Bits of each coordinate, so that a key has at most 32.
template <int D>
constexpr int kBits = D == 2 ? 16 : 10;

/// Moves the bits of a coordinate D places apart.
template <int D>
std::uint32_t spread(std::uint32_t x) {
  if constexpr (D == 2) {
    x = (x | x << 8) & 0x00FF00FF;
    x = (x | x << 4) & 0x0F0F0F0F;
    x = (x | x << 2) & 0x33333333;
    return (x | x << 1) & 0x55555555;
  } else {
    x = (x | x << 16) & 0x030000FF;
    x = (x | x << 8) & 0x0300F00F;
    x = (x | x << 4) & 0x030C30C3;
    return (x | x << 2) & 0x09249249;
  }
}

/// The cell's number along the curve.
template <int D>
std::uint32_t hilbert_key(std::array<std::uint32_t, D> cell) {
  for (std::uint32_t bit = 1U << (kBits<D> - 1); bit > 1; bit >>= 1) {
    const std::uint32_t below = bit - 1;
    for (int k = 0; k < D; ++k) {
      // Either the low bits of axis 0 are inverted, or exchanged with those of axis k.
      const std::uint32_t invert = (cell[k] & bit) != 0 ? below : 0;
      const std::uint32_t exchange = (cell[0] ^ cell[k]) & below & ~invert;
      cell[0] ^= invert | exchange;
      cell[k] ^= exchange;
    }
  }
  for (int k = 1; k < D; ++k) cell[k] ^= cell[k - 1];
  std::uint32_t turned = 0;
  for (std::uint32_t bit = 1U << (kBits<D> - 1); bit > 1; bit >>= 1) {
    turned ^= (cell[D - 1] & bit) != 0 ? bit - 1 : 0;
  }
  std::uint32_t key = 0;
  for (int k = 0; k < D; ++k) key |= spread<D>(cell[k] ^ turned) << (D - 1 - k);
  return key;
}

/// Sorts by the upper 32 bits, stably: three passes over 11 bits each.
void sort_by_key(std::vector<std::uint64_t>& items) {
  constexpr int kDigits = 11;
  constexpr std::uint64_t kMask = (1 << kDigits) - 1;
  std::vector<std::uint64_t> sorted(items.size());
  for (int shift = 32; shift < 64; shift += kDigits) {
    std::array<std::size_t, kMask + 2> place{};
    for (const std::uint64_t item : items) ++place[(item >> shift & kMask) + 1];
    for (std::size_t d = 1; d < place.size(); ++d) place[d] += place[d - 1];
    for (const std::uint64_t item : items) sorted[place[item >> shift & kMask]++] = item;
    std::swap(items, sorted);
  }
}

}  // namespace

template <int D>
std::vector<VertexId> hilbert_order(std::span<const Point<D>> points, const Box<D>& box) {
  constexpr double kLargest = (1 << kBits<D>)-1;
  const double extent = box.extent(box.longest_axis());
  const double scale = extent > 0 ? kLargest / extent : 0;
  std::vector<std::uint64_t> items(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    std::array<std::uint32_t, D> cell;
    for (int k = 0; k < D; ++k) {
      // Written so that NaN, from extents that overflow, becomes 0.
      const double place = (points[i][k] - box.lo[k]) * scale;
      cell[k] = place > 0 ? static_cast<std::uint32_t>(std::min(place, kLargest)) : 0;
    }
    items[i] = std::uint64_t{hilbert_key<D>(cell)} << 32 | i;
  }
  sort_by_key(items);
  std::vector<VertexId> order(points.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = static_cast<VertexId>(items[i]);
  return order;
}

template std::vector<VertexId> hilbert_order<2>(std::span<const Point<2>>, const Box<2>&);
template std::vector<VertexId> hilbert_order<3>(std::span<const Point<3>>, const Box<3>&);

}  // namespace spillway
