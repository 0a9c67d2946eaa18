#include "src/delaunay/base_case/base_case.h"

#include <algorithm>
#include <numeric>

#include "src/delaunay/base_case/affine_basis.h"
#include "src/delaunay/common/tuning.h"
#include "src/delaunay/common/working_memory.h"
#include "src/delaunay/kernel_2d/kernel_2d.h"
#include "src/delaunay/kernel_3d/kernel_3d.h"
#include "src/delaunay/kernel_common/insertion_arena.h"
#include "src/delaunay/kernel_nd/kernel_nd.h"
#include "src/error.h"
#include "src/geometry/dimensions.h"

namespace spillway::delaunay {
namespace {

template <int D>
std::vector<DroppedDuplicate> find_duplicates(const BaseCaseInput<D>& input) {
  std::vector<VertexId> order(input.points.size());
  std::iota(order.begin(), order.end(), VertexId{0});
  std::sort(order.begin(), order.end(), [&](VertexId a, VertexId b) {
    return input.points[a] != input.points[b] ? input.points[a] < input.points[b]
                                              : input.input_index[a] < input.input_index[b];
  });
  std::vector<DroppedDuplicate> duplicates;
  VertexId kept = 0;
  for (const VertexId i : order) {
    if (i == order.front() || input.points[i] != input.points[kept]) {
      kept = i;
    } else {
      duplicates.push_back({input.first_vertex + i, input.first_vertex + kept});
    }
  }
  std::sort(duplicates.begin(), duplicates.end());
  return duplicates;
}

template <int D>
BaseCase<D> triangulate_spanning(const BaseCaseInput<D>& input, std::span<const VertexId> basis) {
  if constexpr (D > 3) {
    if (input.kernel == Kernel::kCgal) {
      throw Failure("CGAL's kernel serves in two and three dimensions only",
                    ErrorCode::kInvalidArgument);
    }
    return kernel_nd_base_case<D>(input, basis);
  } else {
    if (input.kernel == Kernel::kCgal) return cgal_base_case<D>(input, basis);
    if constexpr (D == 2) {
      return kernel_2d_base_case(input, basis);
    } else {
      return kernel_3d_base_case(input, basis);
    }
  }
}

}  // namespace

template <int D>
BaseCase<D> triangulate_base_case(const BaseCaseInput<D>& input) {
  const std::vector<VertexId> basis = affine_basis<D>(input.points);
  if (basis.size() == D + 1) return triangulate_spanning<D>(input, basis);
  BaseCase<D> result;
  result.duplicates = find_duplicates(input);
  result.dimension = static_cast<int>(basis.size()) - 1;
  return result;
}

void release_base_case_memory() {
  InsertionArena::release_kept_memory();
  release_kept_slabs();
}

template <int D>
void release_base_case_memory_above(std::size_t points) {
  release_kept_slabs(points * Tuning<D>::kBaseCaseBytes);
}

#define SPILLWAY_INSTANTIATE(D)                                           \
  template BaseCase<D> triangulate_base_case<D>(const BaseCaseInput<D>&); \
  template void release_base_case_memory_above<D>(std::size_t);
SPILLWAY_FOR_EACH_DIMENSION(SPILLWAY_INSTANTIATE)
#undef SPILLWAY_INSTANTIATE

}  // namespace spillway::delaunay
