#include "src/delaunay/kernel_2d/kernel_2d.h"

#include <cstddef>
#include <cstdint>
#include <type_traits>

#include "src/delaunay/kernel_2d/insertion.h"
#include "src/delaunay/kernel_2d/triangles.h"
#include "src/delaunay/kernel_2d/working_points.h"
#include "src/delaunay/kernel_common/incremental_base_case.h"
#include "src/delaunay/kernel_common/insertion_rounds.h"
#include "src/delaunay/kernel_common/lanes.h"

namespace spillway::delaunay {
namespace kernel_2d {
namespace {

/// See kernel::incremental_base_case.
struct Traits {
  static constexpr int kDimension = 2;
  static constexpr kernel::Rounds kRounds{.factor = 24, .first = 40};
  static constexpr std::size_t kMostPoints = TriangleArray::kMaxTriangles / 2 - 1;
  static constexpr std::uint32_t kVertexUnit = 1;
  using WorkingPoints = kernel_2d::WorkingPoints;
  using Record = Triangle;
  using Array = TriangleArray;
  template <bool kLattice>
  using Insertion = kernel_2d::Insertion<kLattice>;

  static constexpr auto kMakePoints = make_working_points;

  /// All there can be.
  static std::size_t usual_records(std::size_t points) { return 2 * points + 2; }

  static Array array_in(Slab& memory, std::size_t, WorkLease*) { return Array(memory.data()); }

  template <typename Call>
  static BaseCase<2> by_variant(const WorkingPoints& points, const Call& call) {
    return points.lattice ? call(std::true_type{}) : call(std::false_type{});
  }

  /// See docs/algorithm-kernel-2d.md ("Circles inside a box").
  SPILLWAY_INLINE static Reals<2> least_gap_squared(const Records<2>& circles) {
    const Reals<2>& inner = circles.z;
    const Reals<2>& outer = circles.w;
    return outer + (outer - inner);
  }
};

}  // namespace
}  // namespace kernel_2d

BaseCase<2> kernel_2d_base_case(const BaseCaseInput<2>& input, std::span<const VertexId> basis) {
  return kernel::incremental_base_case<kernel_2d::Traits>(input, basis);
}

}  // namespace spillway::delaunay
