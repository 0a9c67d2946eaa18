#include "src/delaunay/kernel_nd/kernel_nd.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <type_traits>

#include "src/delaunay/kernel_common/incremental_base_case.h"
#include "src/delaunay/kernel_nd/insertion.h"
#include "src/delaunay/kernel_nd/listing.h"
#include "src/geometry/dimensions.h"

namespace spillway::delaunay {
namespace kernel_nd {
namespace {

/// See kernel::incremental_base_case.
template <int D>
struct Traits {
  static constexpr int kDimension = D;
  static constexpr kernel::Rounds kRounds{.factor = 16, .first = 40};
  /// What keys of facets have room for.
  static constexpr std::size_t kMostPoints = (std::size_t{1} << std::min(kVertexBits<D>, 29)) - 2;
  static constexpr std::uint32_t kVertexUnit = 1;
  using WorkingPoints = kernel_nd::WorkingPoints<D>;
  using Record = SimplexRecord<D>;
  using Array = SimplexArray<D>;
  template <bool>
  using Insertion = kernel_nd::Insertion<D>;

  static constexpr auto kMakePoints = make_working_points<D>;

  /// Scattered points have about 32, 190 or 1,300 simplices each; few points have fewer.
  static std::size_t usual_records(std::size_t points) {
    constexpr std::size_t kSimplicesOfPoint = D == 4 ? 33 : D == 5 ? 150 : 600;
    return kSimplicesOfPoint * points;
  }

  static SimplexMemory<D> array_in(Slab& memory, std::size_t usual, WorkLease* lease) {
    return {memory, usual + usual / 8, lease};
  }

  template <typename Call>
  static BaseCase<D> by_variant(const WorkingPoints&, const Call& call) {
    return call(std::true_type{});
  }
};

}  // namespace
}  // namespace kernel_nd

template <int D>
BaseCase<D> kernel_nd_base_case(const BaseCaseInput<D>& input, std::span<const VertexId> basis) {
  return kernel::incremental_base_case<kernel_nd::Traits<D>>(input, basis);
}

#define SPILLWAY_INSTANTIATE(D) \
  template BaseCase<D> kernel_nd_base_case<D>(const BaseCaseInput<D>&, std::span<const VertexId>);
SPILLWAY_FOR_EACH_HIGHER_DIMENSION(SPILLWAY_INSTANTIATE)
#undef SPILLWAY_INSTANTIATE

}  // namespace spillway::delaunay
