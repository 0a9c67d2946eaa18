#include "src/delaunay/kernel_3d/kernel_3d.h"

#include <cstddef>
#include <cstdint>
#include <type_traits>

#include "src/delaunay/kernel_3d/cells.h"
#include "src/delaunay/kernel_3d/insertion.h"
#include "src/delaunay/kernel_3d/spheres.h"
#include "src/delaunay/kernel_3d/working_points.h"
#include "src/delaunay/kernel_common/incremental_base_case.h"
#include "src/delaunay/kernel_common/insertion_rounds.h"
#include "src/delaunay/kernel_common/lanes.h"

namespace spillway::delaunay {
namespace kernel_3d {
namespace {

/// See kernel::incremental_base_case.
struct Traits {
  static constexpr int kDimension = 3;
  static constexpr kernel::Rounds kRounds{.factor = 16, .first = 40};
  static constexpr std::size_t kMostPoints = (std::size_t{1} << 28) - 2;
  static constexpr std::uint32_t kVertexUnit = 4;
  using WorkingPoints = kernel_3d::WorkingPoints;
  using Record = Cell;
  using Array = CellArray;
  template <bool kHasOrderKeys>
  using Insertion = kernel_3d::Insertion<kHasOrderKeys>;

  static constexpr auto kMakePoints = make_working_points;

  /// Scattered points have 6.8 cells each.
  static std::size_t usual_records(std::size_t points) { return 7 * points; }

  static CellMemory array_in(Slab& memory, std::size_t usual, WorkLease* lease) {
    return {memory, usual + usual / 8, lease};
  }

  template <typename Call>
  static BaseCase<3> by_variant(const WorkingPoints& points, const Call& call) {
    return points.has_order_keys ? call(std::true_type{}) : call(std::false_type{});
  }

  /// See docs/algorithm-kernel-3d.md ("Spheres inside a box").
  SPILLWAY_INLINE static Reals<2> least_gap_squared(const Records<2>& spheres) {
    const auto tolerance = (Reals<2>)((Integers<2>)spheres.w << kMantissaBits);
    return spheres.w + 2 * tolerance;
  }
};

}  // namespace
}  // namespace kernel_3d

BaseCase<3> kernel_3d_base_case(const BaseCaseInput<3>& input, std::span<const VertexId> basis) {
  return kernel::incremental_base_case<kernel_3d::Traits>(input, basis);
}

}  // namespace spillway::delaunay
