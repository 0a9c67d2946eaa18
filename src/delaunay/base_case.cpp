#include "src/delaunay/base_case.h"

#include <algorithm>
#include <atomic>
#include <mutex>
#include <numeric>
#include <utility>

#include "src/delaunay/affine_basis.h"
#include "src/delaunay/kernel_2d/kernel_2d.h"
#include "src/delaunay/kernel_3d/kernel_3d.h"
#include "src/delaunay/kernel_arena.h"
#include "src/delaunay/working_memory.h"

namespace spillway {
namespace {

std::atomic<BaseCaseKernel> chosen_kernel = BaseCaseKernel::kOwn;

/// Lists of simplices whose memory waits for base cases to come.
template <int D>
struct Recycled {
  std::mutex mutex;
  std::vector<std::vector<Simplex<D>>> lists;  ///< guarded by `mutex`, like the next; all empty
  std::size_t lent = 0;                        ///< to base cases that have not been recycled yet

  static Recycled& instance() {
    static Recycled recycled;
    return recycled;
  }

  void release() {
    const std::lock_guard lock(mutex);
    lists.clear();
  }
};

template <int D>
std::vector<Duplicate> find_duplicates(const BaseCaseInput<D>& input) {
  std::vector<VertexId> order(input.points.size());
  std::iota(order.begin(), order.end(), VertexId{0});
  std::sort(order.begin(), order.end(), [&](VertexId a, VertexId b) {
    return input.points[a] != input.points[b] ? input.points[a] < input.points[b]
                                              : input.input_index[a] < input.input_index[b];
  });
  std::vector<Duplicate> duplicates;
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
  if (chosen_kernel == BaseCaseKernel::kCgal) return cgal_base_case<D>(input, basis);
  if constexpr (D == 2) {
    return kernel_2d_base_case(input, basis);
  } else {
    return kernel_3d_base_case(input, basis);
  }
}

}  // namespace

void set_base_case_kernel(BaseCaseKernel kernel) { chosen_kernel = kernel; }

template <int D>
BaseCase<D> triangulate_base_case(const BaseCaseInput<D>& input) {
  const std::vector<VertexId> basis = affine_basis<D>(input.points);
  if (basis.size() == D + 1) return triangulate_spanning<D>(input, basis);
  BaseCase<D> result;
  result.duplicates = find_duplicates(input);
  result.dimension = static_cast<int>(basis.size()) - 1;
  return result;
}

template <int D>
void recycle(BaseCase<D>&& used) {
  std::vector<Simplex<D>> list = std::move(used.simplices);
  list.clear();
  auto& recycled = Recycled<D>::instance();
  const std::lock_guard lock(recycled.mutex);
  if (recycled.lent == 0) return;  // a kernel that uses none would only fill memory with them
  --recycled.lent;
  recycled.lists.push_back(std::move(list));
}

template <int D>
std::vector<Simplex<D>> recycled_simplices() {
  auto& recycled = Recycled<D>::instance();
  const std::lock_guard lock(recycled.mutex);
  ++recycled.lent;
  if (recycled.lists.empty()) return {};
  std::vector<Simplex<D>> list = std::move(recycled.lists.back());
  recycled.lists.pop_back();
  return list;
}

void release_base_case_memory() {
  Recycled<2>::instance().release();
  Recycled<3>::instance().release();
  KernelArena::release_kept_memory();
  BorrowedMemory::release_kept_memory();
}

template BaseCase<2> triangulate_base_case<2>(const BaseCaseInput<2>&);
template BaseCase<3> triangulate_base_case<3>(const BaseCaseInput<3>&);
template void recycle<2>(BaseCase<2>&&);
template void recycle<3>(BaseCase<3>&&);
template std::vector<Simplex<2>> recycled_simplices<2>();
template std::vector<Simplex<3>> recycled_simplices<3>();

}  // namespace spillway
