#include "src/delaunay/kernel_common/hilbert_order.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <utility>
#include <vector>

#include "src/delaunay/common/working_memory.h"
#include "src/delaunay/kernel_common/lanes.h"
#include "src/geometry/dimensions.h"

namespace spillway::delaunay {
namespace {

/// One coordinate of the cells of eight points, or a bit of each level for them.
using Lanes [[gnu::vector_size(16)]] = std::uint16_t;
using SignedLanes [[gnu::vector_size(16)]] = std::int16_t;
/// Their positions along the curve.
using Keys [[gnu::vector_size(32)]] = std::uint32_t;
/// Keys have two digits, of at most this many bits.
constexpr int kWidestDigit = 13;
constexpr std::size_t kLanes = sizeof(Lanes) / sizeof(std::uint16_t);

/// Adds bits, in space of 8 levels at most (D > 3: of 26 / D), to keys: D positions apart, the
/// lowest one at `shift`.
template <int D>
SPILLWAY_INLINE void add_spread(const Lanes& bits, int shift, Keys& keys) {
  Keys x = __builtin_convertvector(bits, Keys);
  if constexpr (D == 2) {
    x = (x | x << 8) & 0x00FF00FF;
    x = (x | x << 4) & 0x0F0F0F0F;
    x = (x | x << 2) & 0x33333333;
    x = (x | x << 1) & 0x55555555;
  } else if constexpr (D > 3) {
    const Keys narrow = x;
    x = Keys{};
    for (int level = 0; level < 2 * kWidestDigit / D; ++level) {
      x |= (narrow >> level & 1) << (D * level);
    }
  } else {
    x = (x | x << 8) & 0x0000F00F;
    x = (x | x << 4) & 0x000C30C3;
    x = (x | x << 2) & 0x00249249;
  }
  keys |= x << shift;
}

/// The cells' numbers along the curve in the plane. Inside a square the curve is the whole one,
/// with the axes exchanged, or turned by half a turn (v), or both; t is 1 if just one is true. In
/// the quarter x, y, by the next bits of a cell's coordinates, the curve has the digits
/// x ^ (x == y ? v : t) and x ^ y, and there t ^= ~(x ^ v) if x == y, otherwise v ^= x ^ t. Such
/// maps are affine: those of 2, 4, ... levels, which are composed here for all levels at once, have
/// matrices (p q; q p^q).
SPILLWAY_INLINE void hilbert_keys(const std::array<Lanes, 2>& cells, int /*levels*/, Keys& keys) {
  const Lanes x = cells[0];
  const Lanes unlike = cells[0] ^ cells[1];
  const Lanes t1 = ~(cells[0] | cells[1]);
  const Lanes v1 = x & unlike;
  Lanes t = t1 ^ t1 >> 1 ^ (v1 >> 1 & ~unlike);
  Lanes v = v1 ^ v1 >> 1 ^ (t1 >> 1 & unlike);
  Lanes p = unlike | ~unlike >> 1;
  Lanes q = unlike ^ unlike >> 1;
  for (int levels = 2; levels < 16; levels *= 2) {
    const Lanes t_above = t >> levels;
    const Lanes v_above = v >> levels;
    t ^= (p & t_above) ^ (q & v_above);
    v ^= (q & t_above) ^ ((p ^ q) & v_above);
    const Lanes p_above = p >> levels;
    const Lanes q_above = q >> levels;
    const Lanes both = q & q_above;
    q = (p & q_above) ^ (q & p_above) ^ both;
    p = (p & p_above) ^ both;
  }
  const Lanes state = (unlike & t >> 1) | (v >> 1 & ~unlike);
  keys = Keys{};
  add_spread<2>(x ^ state, 1, keys);
  add_spread<2>(unlike, 0, keys);
}

/// The cells' numbers along the curve in D > 2 dimensions, of 8 levels at most (J. Skilling,
/// "Programming the Hilbert curve", AIP Conference Proceedings 707 (2004)).
template <std::size_t D>
SPILLWAY_INLINE void hilbert_keys(std::array<Lanes, D> cells, int levels, Keys& keys) {
  for (int level = levels - 1; level > 0; --level) {
    const auto below = static_cast<std::uint16_t>((1U << level) - 1);
    for (std::size_t k = 0; k < D; ++k) {
      // Either the low bits of axis 0 are inverted, or exchanged with those of axis k.
      const Lanes set = (Lanes)((SignedLanes)(cells[k] << (15 - level)) >> 15);
      const Lanes exchange = (cells[0] ^ cells[k]) & (below & ~set);
      cells[0] ^= (set & below) | exchange;
      cells[k] ^= exchange;
    }
  }
  for (std::size_t k = 1; k < D; ++k) cells[k] ^= cells[k - 1];
  Lanes turned = cells[D - 1] >> 1;
  for (int shift = 1; shift < 8; shift *= 2) turned ^= turned >> shift;
  keys = Keys{};
  for (std::size_t k = 0; k < D; ++k) {
    add_spread<D>(cells[k] ^ turned, static_cast<int>(D - 1 - k), keys);
  }
}

/// Sorts positions of points by their keys, stably.
template <int D>
class Sorter {
 public:
  explicit Sorter(std::span<const Point<D>> points)
      : points_(points),
        count_(points.size()),
        position_bits_(std::bit_width(count_)),
        memory_(SlabUse::kSimplices, 2 * count_ * sizeof(std::uint32_t)),
        keys_(static_cast<std::uint32_t*>(memory_->reserve(2 * count_ * sizeof(std::uint32_t)))),
        items_(keys_ + count_),
        order_(count_) {}

  std::vector<VertexId> sort(const Box<D>& box) && {
    sort_range({0, count_}, box, [](std::size_t i) { return static_cast<VertexId>(i); });
    return std::move(order_);
  }

 private:
  /// So few points in one cell are not divided further; twice as many are.
  static constexpr std::size_t kFewPoints = 12;
  /// A base case takes longer if a point has fewer cells than this; more do not help it. Of more
  /// than two million points, whose numbers leave less room for keys, crowded cells make up for it.
  static constexpr std::size_t kCellsOfPoint = 4;
  /// Smaller boxes have no cells: how many there are in a unit of length could overflow.
  static constexpr double kSmallestExtent = 1e-300;
  /// Where there are more points, what is written lies outside of the fastest cache.
  static constexpr std::size_t kManyPoints = std::size_t{1} << 16;
  static constexpr std::size_t kAhead = 32;

  /// Of `order_`: [begin, end).
  struct Range {
    std::size_t begin, end;
    [[nodiscard]] std::size_t size() const { return end - begin; }
  };

  /// Of each digit, how many there are below, and then where the next one goes.
  using Positions = std::array<std::uint32_t, std::size_t{1} << kWidestDigit>;

  /// Sorts a range, which has the points at position_at(begin), ..., and then what is crowded in
  /// it.
  template <typename PositionAt>
  void sort_range(const Range& range, const Box<D>& box, const PositionAt& position_at) {
    const int digit = std::min<int>(kWidestDigit, std::bit_width(range.size()) + 2);
    const int most_levels = (digit + std::min(digit, 32 - position_bits_)) / D;
    int levels = 1;
    while (levels < most_levels && std::size_t{1} << (D * levels) < kCellsOfPoint * range.size()) {
      ++levels;
    }
    const double extent = box.extent(box.longest_axis());
    if (!(extent > kSmallestExtent && extent <= std::numeric_limits<double>::max())) {
      for (std::size_t i = range.begin; i < range.end; ++i) order_[i] = position_at(i);
      return;
    }
    int low_bits = set_keys(range, box.lo, extent, levels, position_at);
    if (levels < most_levels && concentrated(D * levels - low_bits)) {
      levels = most_levels;
      low_bits = set_keys(range, box.lo, extent, levels, position_at);
    }
    make_positions(range, low_, low_bits);
    make_positions(range, high_, D * levels - low_bits);
    sort_by_key(range, low_bits, position_at);
    sort_crowded_cells(range);
  }

  /// Whether less than a third of the box has points, by the high digits: they need smaller cells.
  [[nodiscard]] bool concentrated(int high_bits) const {
    const auto end = high_.begin() + (std::ptrdiff_t{1} << high_bits);
    return 3 * (end - high_.begin() - std::count(high_.begin(), end, 0U)) < end - high_.begin();
  }

  /// Sets keys, and counts their digits. Returns how many bits the low one has.
  template <typename PositionAt>
  int set_keys(const Range& range, const Point<D>& lo, double extent, int levels,
               const PositionAt& position_at) {
    const int high_bits = std::min((D * levels + 1) / 2, 32 - position_bits_);
    const int low_bits = D * levels - high_bits;
    std::fill_n(low_.begin(), std::size_t{1} << low_bits, 0);
    std::fill_n(high_.begin(), std::size_t{1} << high_bits, 0);
    // The largest coordinate is still in the last cell.
    const double scale = std::ldexp(1 - 0x1p-50, levels) / extent;
    constexpr std::size_t kBatch = 8 * kLanes;
    std::array<std::array<std::uint16_t, kBatch>, D> cells{};
    std::array<std::uint32_t, kBatch> keys;
    const std::uint32_t mask = (1U << low_bits) - 1;
    for (std::size_t begin = range.begin; begin < range.end; begin += kBatch) {
      const std::size_t size = std::min(kBatch, range.end - begin);
      for (std::size_t j = 0; j < size; ++j) {
        const Point<D>& p = points_[position_at(begin + j)];
        for (int k = 0; k < D; ++k) {
          cells[k][j] =
              static_cast<std::uint16_t>(static_cast<std::int32_t>((p[k] - lo[k]) * scale));
        }
      }
      for (std::size_t j = 0; j < size; j += kLanes) {
        std::array<Lanes, D> lanes;
        for (int k = 0; k < D; ++k) std::memcpy(&lanes[k], &cells[k][j], sizeof(Lanes));
        Keys keys_of_lanes;
        hilbert_keys(lanes, levels, keys_of_lanes);
        std::memcpy(&keys[j], &keys_of_lanes, sizeof(Keys));
      }
      for (std::size_t j = 0; j < size; ++j) {
        keys_[position_at(begin + j)] = keys[j];
        ++low_[keys[j] & mask];
        ++high_[keys[j] >> low_bits];
      }
    }
    return low_bits;
  }

  /// Turns counts into positions in the range.
  static void make_positions(const Range& range, Positions& positions, int bits) {
    auto next = static_cast<std::uint32_t>(range.begin);
    for (std::size_t digit = 0; digit >> bits == 0; ++digit) {
      next += std::exchange(positions[digit], next);
    }
  }

  /// Sorts by the low digits into items, which have the high digit above the position, and these by
  /// the high ones.
  template <typename PositionAt>
  void sort_by_key(const Range& range, int low_bits, const PositionAt& position_at) {
    const std::size_t prefetched = range.size() > kManyPoints ? range.end - kAhead : range.begin;
    const std::uint32_t mask = (1U << low_bits) - 1;
    for (std::size_t i = range.begin; i < range.end; ++i) {
      if (i < prefetched) {
        __builtin_prefetch(&items_[low_[keys_[position_at(i + kAhead)] & mask]], 1);
      }
      const VertexId position = position_at(i);
      const std::uint64_t high = keys_[position] >> low_bits;
      items_[low_[keys_[position] & mask]++] =
          static_cast<std::uint32_t>(high << position_bits_ | position);
    }
    for (std::size_t i = range.begin; i < range.end; ++i) {
      if (i < prefetched) {
        __builtin_prefetch(&order_[high_[std::uint64_t{items_[i + kAhead]} >> position_bits_]], 1);
      }
      const std::uint64_t item = items_[i];
      const std::uint64_t high = item >> position_bits_;
      order_[high_[high]++] = static_cast<VertexId>(item ^ high << position_bits_);
    }
  }

  /// Gives each cell with many points in the sorted range a curve of its own.
  void sort_crowded_cells(const Range& range) {
    const auto key_at = [this](std::size_t i) { return keys_[order_[i]]; };
    std::size_t done = range.begin;
    for (std::size_t i = range.begin; i + kFewPoints < range.end;) {
      const std::uint32_t key = key_at(i);
      if (key_at(i + kFewPoints) != key) {
        i += kFewPoints;
        continue;
      }
      Range cell{i, i + kFewPoints + 1};
      while (cell.begin > done && key_at(cell.begin - 1) == key) --cell.begin;
      while (cell.end < range.end && key_at(cell.end) == key) ++cell.end;
      Box<D> box;
      for (std::size_t j = cell.begin; j < cell.end; ++j) box.expand(points_[order_[j]]);
      if (box.lo != box.hi) sort_range(cell, box, [this](std::size_t j) { return order_[j]; });
      i = done = cell.end;
    }
  }

  std::span<const Point<D>> points_;
  std::size_t count_;
  int position_bits_;
  BorrowedSlab memory_;  ///< a base case is likely to follow
  std::uint32_t* keys_;  ///< by position
  std::uint32_t* items_;
  std::vector<VertexId> order_;
  Positions low_, high_;
};

}  // namespace

template <int D>
std::vector<VertexId> hilbert_order(std::span<const Point<D>> points, const Box<D>& box) {
  return Sorter<D>(points).sort(box);
}

#define SPILLWAY_INSTANTIATE(D) \
  template std::vector<VertexId> hilbert_order<D>(std::span<const Point<D>>, const Box<D>&);
SPILLWAY_FOR_EACH_DIMENSION(SPILLWAY_INSTANTIATE)
#undef SPILLWAY_INSTANTIATE

}  // namespace spillway::delaunay
