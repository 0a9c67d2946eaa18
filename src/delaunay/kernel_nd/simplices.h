#pragma once
// The simplices of a triangulation in more than three dimensions, as the kernel keeps them.

#include <array>
#include <cstddef>
#include <cstdint>

#include "src/delaunay/kernel_common/insertion_rounds.h"
#include "src/delaunay/kernel_common/lanes.h"
#include "src/geometry/point.h"

namespace spillway::delaunay::kernel_nd {

/// A facet: eight times the number of a simplex, and the slot of the vertex opposite to it.
using Facet = std::uint32_t;

/// Tells on which side of a circumsphere a point is. The value for a point is negative inside and
/// positive outside, wherever its magnitude is above the tolerance; else exact predicates decide.
/// For an infinite simplex it is the same of the half-space beyond its facet.
template <int D>
struct PowerFunction {
  std::array<double, D> gradient;  ///< -2 times the centre, or a normal that points inwards
  double constant;
  float tolerance;  ///< infinite where the value proves nothing
  float curvature;  ///< 1; 0 of a half-space

  /// `row` is that of a point: its coordinates and the sum of their squares.
  [[nodiscard]] SPILLWAY_INLINE double value(const double* row) const {
    kernel::Reals<2> pairs{};
    for (int k = 0; k + 1 < D; k += 2) {
      kernel::Reals<2> slopes, coordinates;
      kernel::load(&gradient[k], slopes);
      kernel::load(row + k, coordinates);
      pairs += slopes * coordinates;
    }
    double sum = (pairs[0] + pairs[1]) + curvature * row[D];
    if constexpr (D % 2 != 0) sum += gradient[D - 1] * row[D - 1];
    return sum + constant;
  }
};

/// D + 1 vertices, positively oriented, in an infinite simplex as Simplex says.
template <int D>
struct SimplexRecord {
  std::array<VertexId, D + 1> vertices;
  std::array<Facet, D + 1> neighbours;  ///< opposite to them: the same facets in the neighbours
  PowerFunction<D> power;
  std::uint32_t mark;  ///< what the last search for a hole has found, or kFree

  static constexpr std::uint32_t kFree = ~std::uint32_t{0};

  /// The slot of a vertex, or D + 1 if it has none.
  [[nodiscard]] int slot_of(VertexId v) const {
    int slot = 0;
    while (slot <= D && vertices[slot] != v) ++slot;
    return slot;
  }
  [[nodiscard]] int infinite_slot() const { return slot_of(kernel::kInfinite); }
  [[nodiscard]] bool infinite() const { return infinite_slot() <= D; }
};

/// Simplices by number.
template <int D>
class SimplexArray {
 public:
  using Record = SimplexRecord<D>;
  static constexpr int kNumberShift = 3;  ///< of a facet, to the simplex's number
  static constexpr std::size_t kMostRecords = std::size_t{1} << (32 - kNumberShift);

  SimplexArray() = default;
  explicit SimplexArray(void* memory) : records_(static_cast<Record*>(memory)) {}

  static constexpr Facet facet(std::uint32_t number, int slot) {
    return number << kNumberShift | static_cast<std::uint32_t>(slot);
  }
  static constexpr std::uint32_t number(Facet facet) { return facet >> kNumberShift; }
  static constexpr int slot(Facet facet) {
    return static_cast<int>(facet & ((1U << kNumberShift) - 1));
  }

  [[nodiscard]] Record& record(std::uint32_t number) const { return records_[number]; }
  /// The simplex of a facet.
  [[nodiscard]] Record& at(Facet facet) const { return records_[number(facet)]; }
  void join(Facet a, Facet b) const {
    at(a).neighbours[slot(a)] = b;
    at(b).neighbours[slot(b)] = a;
  }

 private:
  Record* records_ = nullptr;
};

}  // namespace spillway::delaunay::kernel_nd
