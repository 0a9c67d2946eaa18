#include "src/delaunay/hilbert_order.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <utility>
#include <vector>

#include "src/delaunay/working_memory.h"

namespace spillway {
namespace {

/// Bits of each coordinate at most, so that a key has at most 32.
template <int D>
constexpr int kMostBits = D == 2 ? 16 : 10;

/// The curve in the plane, four levels at a time. A square's curve is the whole one with the axes
/// exchanged (bit 0 of the state), turned by half a turn (bit 1), or both.
struct CurveTable {
  static constexpr int kLevels = 4;
  static constexpr std::size_t kCells = std::size_t{1} << kLevels;
  struct Entry {
    std::uint8_t digits;  ///< the cell's number along the curve
    std::uint8_t state;   ///< of the curve inside the cell
  };
  std::array<std::array<Entry, kCells * kCells>, 4> entries{};

  constexpr CurveTable() {
    for (unsigned state = 0; state < 4; ++state) {
      for (unsigned cell = 0; cell < kCells * kCells; ++cell)
        entries[state][cell] = walk(state, cell);
    }
  }

 private:
  static constexpr Entry walk(unsigned state, unsigned cell) {
    unsigned digits = 0;
    for (int level = kLevels - 1; level >= 0; --level) {
      unsigned x = (cell >> (level + kLevels) & 1) ^ (state >> 1);
      unsigned y = (cell >> level & 1) ^ (state >> 1);
      if ((state & 1) != 0) std::swap(x, y);
      const unsigned quarter = (3 * x) ^ y;
      digits = 4 * digits + quarter;
      if (quarter == 0) state ^= 1;
      if (quarter == 3) state ^= 3;
    }
    return {static_cast<std::uint8_t>(digits), static_cast<std::uint8_t>(state)};
  }
};

/// The cell's number along the curve in the plane.
std::uint32_t hilbert_key(const std::array<std::uint32_t, 2>& cell) {
  static constexpr CurveTable kTable;
  constexpr unsigned kMask = CurveTable::kCells - 1;
  std::uint32_t key = 0;
  unsigned state = 0;
  for (int level = kMostBits<2> - CurveTable::kLevels; level >= 0; level -= CurveTable::kLevels) {
    const unsigned x = cell[0] >> level & kMask;
    const unsigned y = cell[1] >> level & kMask;
    const CurveTable::Entry& entry = kTable.entries[state][x * CurveTable::kCells + y];
    key = key << (2 * CurveTable::kLevels) | entry.digits;
    state = entry.state;
  }
  return key;
}

/// Moves the bits of a coordinate three places apart.
std::uint32_t spread(std::uint32_t x) {
  x = (x | x << 16) & 0x030000FF;
  x = (x | x << 8) & 0x0300F00F;
  x = (x | x << 4) & 0x030C30C3;
  return (x | x << 2) & 0x09249249;
}

/// The cell's number along the curve in space, by the rule (J. Skilling's algorithm).
std::uint32_t hilbert_key_by_rule(std::array<std::uint32_t, 3> cell) {
  for (std::uint32_t bit = 1U << (kMostBits<3> - 1); bit > 1; bit >>= 1) {
    const std::uint32_t below = bit - 1;
    for (int k = 0; k < 3; ++k) {
      // Either the low bits of axis 0 are inverted, or exchanged with those of axis k.
      const std::uint32_t invert = (cell[k] & bit) != 0 ? below : 0;
      const std::uint32_t exchange = (cell[0] ^ cell[k]) & below & ~invert;
      cell[0] ^= invert | exchange;
      cell[k] ^= exchange;
    }
  }
  for (int k = 1; k < 3; ++k) cell[k] ^= cell[k - 1];
  std::uint32_t turned = 0;
  for (std::uint32_t bit = 1U << (kMostBits<3> - 1); bit > 1; bit >>= 1) {
    turned ^= (cell[2] & bit) != 0 ? bit - 1 : 0;
  }
  std::uint32_t key = 0;
  for (int k = 0; k < 3; ++k) key |= spread(cell[k] ^ turned) << (2 - k);
  return key;
}

/// The curve in space, two levels at a time. Inside each octant of a cube it is the whole curve,
/// mirrored and with the axes exchanged.
class SpaceCurveTable {
 public:
  SpaceCurveTable() {
    for (std::uint32_t octant = 0; octant < kOctants; ++octant) {
      place_[octant] = key_of_octants({octant}) >> (kKeyBits - 3);
      turn_[octant] = find_turn(octant);
    }
    for (std::uint32_t state = 0; state < kTurns; ++state) {
      for (std::uint32_t cell = 0; cell < kOctants * kOctants; ++cell) {
        const std::uint32_t first = turned(state, cell >> 3);
        const std::uint32_t inside = composed(turn_[first], state);
        const std::uint32_t second = turned(inside, cell & 7);
        entries_[state][cell] = {static_cast<std::uint8_t>(place_[first] << 3 | place_[second]),
                                 static_cast<std::uint8_t>(composed(turn_[second], inside))};
      }
    }
  }

  [[nodiscard]] std::uint32_t key(const std::array<std::uint32_t, 3>& cell) const {
    // The cell's octants, the largest first.
    const std::uint32_t octants = spread(cell[0]) << 2 | spread(cell[1]) << 1 | spread(cell[2]);
    std::uint32_t key = 0;
    std::uint32_t state = 0;
    for (int shift = kKeyBits - 6; shift >= 0; shift -= 6) {
      const Entry& entry = entries_[state][octants >> shift & 63];
      key = key << 6 | entry.digits;
      state = entry.state;
    }
    return key;
  }

 private:
  struct Entry {
    std::uint8_t digits;  ///< the cell's number along the curve
    std::uint8_t state;   ///< of the curve inside the cell: a turn
  };
  static constexpr int kKeyBits = 3 * kMostBits<3>;
  static constexpr std::uint32_t kOctants = 8;
  /// Turns: one of six orders of the axes, and bits that are inverted, 8 * order + bits.
  static constexpr std::uint32_t kTurns = 48;
  static constexpr std::array<std::array<std::uint8_t, 3>, 6> kOrders{
      {{0, 1, 2}, {0, 2, 1}, {1, 0, 2}, {1, 2, 0}, {2, 0, 1}, {2, 1, 0}}};

  static std::uint32_t turned(std::uint32_t turn, std::uint32_t octant) {
    const auto& order = kOrders[turn >> 3];
    std::uint32_t result = turn & 7;
    for (std::uint32_t k = 0; k < 3; ++k) result ^= (octant >> order[k] & 1) << k;
    return result;
  }

  /// The turn that does what `second` does to the result of `first`.
  static std::uint32_t composed(std::uint32_t second, std::uint32_t first) {
    for (std::uint32_t turn = 0; turn < kTurns; ++turn) {
      bool same = true;
      for (std::uint32_t octant = 0; octant < kOctants; ++octant) {
        same &= turned(turn, octant) == turned(second, turned(first, octant));
      }
      if (same) return turn;
    }
    return 0;
  }

  /// The key of a cell given by its octants, the largest first; those that are missing are 0.
  static std::uint32_t key_of_octants(std::array<std::uint32_t, 3> octants) {
    std::array<std::uint32_t, 3> cell{};
    for (std::size_t level = 0; level < octants.size(); ++level) {
      for (std::size_t k = 0; k < 3; ++k) {
        cell[k] |= (octants[level] >> (2 - k) & 1) << (kMostBits<3> - 1 - level);
      }
    }
    return hilbert_key_by_rule(cell);
  }

  /// How the curve inside an octant lies, found by comparing two levels of it with the whole.
  static std::uint32_t find_turn(std::uint32_t octant) {
    for (std::uint32_t turn = 0; turn < kTurns; ++turn) {
      bool same = true;
      for (std::uint32_t cell = 0; cell < kOctants * kOctants; ++cell) {
        const std::uint32_t first = cell >> 3;
        const std::uint32_t second = cell & 7;
        same &= (key_of_octants({octant, first, second}) >> (kKeyBits - 9) & 63) ==
                key_of_octants({turned(turn, first), turned(turn, second)}) >> (kKeyBits - 6);
      }
      if (same) return turn;
    }
    return 0;
  }

  std::array<std::uint32_t, kOctants> place_{};
  std::array<std::uint32_t, kOctants> turn_{};
  std::array<std::array<Entry, kOctants * kOctants>, kTurns> entries_{};
};

/// The cell's number along the curve in space.
std::uint32_t hilbert_key(const std::array<std::uint32_t, 3>& cell) {
  static const SpaceCurveTable table;
  return table.key(cell);
}

/// Sorts places by key. An item has the key in its upper half, the place in its lower one.
template <int D>
class Sorter {
 public:
  explicit Sorter(std::span<const Point<D>> points)
      : points_(points),
        count_(points.size()),
        items_(static_cast<Item*>((*memory_).simplices.reserve(2 * count_ * sizeof(Item)))),
        other_(items_ + count_) {
    for (std::size_t i = 0; i < count_; ++i) items_[i] = i;
  }

  /// Sorts all items, then again those that share a cell with many.
  std::vector<VertexId> sort(const Box<D>& box) && {
    sort_range(0, count_, box);
    std::vector<VertexId> order(count_);
    for (std::size_t i = 0; i < order.size(); ++i) order[i] = static_cast<VertexId>(items_[i]);
    return order;
  }

 private:
  using Item = std::uint64_t;
  /// So few are not divided further.
  static constexpr std::size_t kFewPoints = 24;
  static constexpr std::size_t kSmallestRadixSort = 512;

  /// Items [begin, end).
  struct Range {
    std::size_t begin, end;
    [[nodiscard]] std::size_t size() const { return end - begin; }
  };

  void sort_range(std::size_t begin, std::size_t end, const Box<D>& box) {
    const std::size_t count = end - begin;
    set_keys(begin, end, box);
    int bits = kMostBits<D>;  // of a coordinate
    if (count < kSmallestRadixSort) {
      std::sort(&items_[begin], &items_[begin] + count);
    } else {
      // Two cells a point are enough, unless many points share one.
      while (bits > 1 && (std::size_t{1} << (D * (bits - 1))) >= 2 * count) --bits;
      radix_sort(begin, end, D * bits);
    }
    std::vector<Range> crowded = crowded_cells(begin, end, D * bits);
    const std::size_t points_there =
        std::accumulate(crowded.begin(), crowded.end(), std::size_t{0},
                        [](std::size_t sum, const Range& cell) { return sum + cell.size(); });
    if (bits < kMostBits<D> && points_there > count / 8) {
      radix_sort(begin, end, D * kMostBits<D>);
      crowded = crowded_cells(begin, end, D * kMostBits<D>);
    }
    for (const Range& cell : crowded) {
      if (cell.size() < count) sort_cell(cell);
    }
  }

  /// The items of each cell that has many.
  [[nodiscard]] std::vector<Range> crowded_cells(std::size_t begin, std::size_t end,
                                                 int key_bits) const {
    const int shift = 64 - key_bits;
    std::vector<Range> cells;
    for (std::size_t i = begin; i + kFewPoints < end;) {
      const Item cell = items_[i] >> shift;
      if (items_[i + kFewPoints] >> shift != cell) {
        do {
          ++i;
        } while (items_[i] >> shift == cell);
        continue;
      }
      std::size_t j = i + kFewPoints + 1;
      while (j < end && items_[j] >> shift == cell) ++j;
      cells.push_back({i, j});
      i = j;
    }
    return cells;
  }

  /// A crowded cell gets a curve of its own.
  void sort_cell(const Range& cell) {
    Box<D> box;
    for (std::size_t i = cell.begin; i < cell.end; ++i) box.expand(point(items_[i]));
    if (box.lo != box.hi) sort_range(cell.begin, cell.end, box);
  }

  [[nodiscard]] const Point<D>& point(Item item) const {
    return points_[static_cast<VertexId>(item)];
  }

  void set_keys(std::size_t begin, std::size_t end, const Box<D>& box) {
    constexpr double kLargest = (1 << kMostBits<D>)-1;
    const double extent = box.extent(box.longest_axis());
    const double scale = extent > 0 ? kLargest / extent : 0;
    for (std::size_t i = begin; i < end; ++i) {
      const Point<D>& p = point(items_[i]);
      std::array<std::uint32_t, D> cell;
      for (int k = 0; k < D; ++k) {
        // Written so that NaN, from extents that overflow, becomes 0.
        const double place = (p[k] - box.lo[k]) * scale;
        cell[k] = place > 0 ? static_cast<std::uint32_t>(std::min(place, kLargest)) : 0;
      }
      items_[i] =
          Item{hilbert_key(cell)} << (64 - D * kMostBits<D>) | static_cast<VertexId>(items_[i]);
    }
  }

  /// Sorts by the highest bits, stably, in passes over digits of equal width.
  void radix_sort(std::size_t begin, std::size_t end, int key_bits) {
    constexpr int kWidestDigit = 11;
    const int passes = (key_bits + kWidestDigit - 1) / kWidestDigit;
    const int digit = (key_bits + passes - 1) / passes;
    const int lowest = 64 - key_bits;
    const Item mask = (Item{1} << digit) - 1;
    std::array<std::array<std::uint32_t, 1 << kWidestDigit>, 3> places{};
    for (std::size_t i = begin; i < end; ++i) {
      const Item key = items_[i] >> lowest;
      for (int pass = 0; pass < passes; ++pass) ++places[pass][key >> (pass * digit) & mask];
    }
    for (int pass = 0; pass < passes; ++pass) {
      auto& place = places[pass];
      auto next = static_cast<std::uint32_t>(begin);
      for (std::size_t d = 0; d <= mask; ++d) next += std::exchange(place[d], next);
      const int shift = lowest + pass * digit;
      for (std::size_t i = begin; i < end; ++i) {
        const Item item = items_[i];
        other_[place[item >> shift & mask]++] = item;
      }
      if (end - begin == count_) {
        std::swap(items_, other_);
      } else {
        std::copy(&other_[begin], &other_[begin] + (end - begin), &items_[begin]);
      }
    }
  }

  std::span<const Point<D>> points_;
  std::size_t count_;
  BorrowedMemory memory_;  ///< of base cases, of which one is likely to follow
  Item* items_;
  Item* other_;
};

}  // namespace

template <int D>
std::vector<VertexId> hilbert_order(std::span<const Point<D>> points, const Box<D>& box) {
  return Sorter<D>(points).sort(box);
}

template std::vector<VertexId> hilbert_order<2>(std::span<const Point<2>>, const Box<2>&);
template std::vector<VertexId> hilbert_order<3>(std::span<const Point<3>>, const Box<3>&);

}  // namespace spillway
