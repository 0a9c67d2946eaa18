#pragma once
// What incremental insertion has in common in all dimensions: the numbers of its vertices,
// the order in which points come, and what becomes of points that equal another.

#include <algorithm>
#include <cstdint>
#include <numeric>
#include <span>
#include <vector>

#include "src/delaunay/kernel_common/kernel.h"

namespace spillway::delaunay::kernel {

/// The kernels' own vertex numbers: the infinite vertex, then the points in their order.
inline constexpr VertexId kInfinite = 0;
inline constexpr VertexId kFirstPoint = 1;

/// A point that was found to equal a vertex, by these numbers.
struct Repetition {
  VertexId point;
  VertexId vertex;
};

/// After a round there are `factor` times the points that there were before; the first round has at
/// most `first`.
struct Rounds {
  std::size_t factor;
  std::size_t first;
};

/// Calls visit(i) for all i < count in rounds, each in ascending order and spread evenly over
/// the numbers, and end_round(n) after each, when n have been visited.
template <typename Visit, typename EndRound>
void for_each_in_rounds(std::size_t count, const Rounds& rounds, const Visit& visit,
                        const EndRound& end_round) {
  std::size_t stride = 1;
  while (count / stride > rounds.first) stride *= rounds.factor;
  for (std::size_t i = 0; i < count; i += stride) visit(i);
  end_round((count + stride - 1) / stride);
  for (; stride > 1; stride /= rounds.factor) {
    const std::size_t step = stride / rounds.factor;
    for (std::size_t group = 0; group < count; group += stride) {
      const std::size_t end = std::min(count, group + stride);
      for (std::size_t i = group + step; i < end; i += step) visit(i);
    }
    end_round((count + step - 1) / step);
  }
}

/// Calls insertion.insert(point, next) in rounds for all `count` points but those of the basis, and
/// insertion.end_round(points), if there is such a thing, after each round.
template <typename Insertion>
void insert_in_rounds(Insertion& insertion, std::size_t count, std::span<const VertexId> basis,
                      const Rounds& rounds) {
  // One after the rounds, so that an insertion knows which point comes next.
  VertexId pending = kInfinite;
  for_each_in_rounds(
      count, rounds,
      [&](std::size_t i) {
        if (std::find(basis.begin(), basis.end(), i) != basis.end()) return;
        const auto next = static_cast<VertexId>(i + kFirstPoint);
        if (pending != kInfinite) insertion.insert(pending, next);
        pending = next;
      },
      [&](std::size_t points) {
        if constexpr (requires { insertion.end_round(points); }) insertion.end_round(points);
      });
  if (pending != kInfinite) insertion.insert(pending, pending);
}

/// For each vertex, the point that stands for it: of equal ones that of the lowest input index.
template <int D>
std::vector<VertexId> choose_kept(const BaseCaseInput<D>& input,
                                  std::span<const Repetition> repetitions) {
  std::vector<VertexId> kept(input.points.size() + kFirstPoint);
  std::iota(kept.begin(), kept.end(), VertexId{0});
  const auto index = [&](VertexId v) { return input.input_index[v - kFirstPoint]; };
  for (const Repetition& r : repetitions) {
    VertexId& best = kept[r.vertex];
    if (index(r.point) < index(best)) best = r.point;
  }
  return kept;
}

inline std::vector<DroppedDuplicate> list_duplicates(std::span<const Repetition> repetitions,
                                                     std::span<const VertexId> kept,
                                                     VertexId first_vertex) {
  const VertexId shift = first_vertex - kFirstPoint;
  std::vector<DroppedDuplicate> duplicates;
  for (const Repetition& r : repetitions) {
    // The point that was inserted is dropped where it was not the one to keep, in its stead.
    const VertexId dropped = kept[r.vertex] == r.point ? r.vertex : r.point;
    duplicates.push_back({dropped + shift, kept[r.vertex] + shift});
  }
  std::sort(duplicates.begin(), duplicates.end());
  return duplicates;
}

}  // namespace spillway::delaunay::kernel
