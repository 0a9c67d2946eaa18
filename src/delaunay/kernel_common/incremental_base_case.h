#pragma once
// A base case of the own kernels, from the points to the list of simplices: what is the same in all
// dimensions.

#include <fmt/format.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <type_traits>
#include <vector>

#include "src/delaunay/common/working_memory.h"
#include "src/delaunay/kernel_common/insertion_rounds.h"
#include "src/delaunay/kernel_common/kernel.h"
#include "src/delaunay/kernel_common/lane_width.h"
#include "src/delaunay/kernel_common/simplex_listing.h"
#include "src/error.h"
#include "src/runtime/work_lease.h"

namespace spillway::delaunay::kernel {

/// Replaces a vertex, or each of four, by f(it).
template <typename V, typename F>
SPILLWAY_INLINE void set_each(V& v, const F& f) {
  if constexpr (std::is_integral_v<V>) {
    v = f(v);
  } else {
    for (int i = 0; i < 4; ++i) v[i] = f(v[i]);
  }
}

/// Lists what an insertion has made: in the slab where its records lie, which it is done with, or
/// in memory of its own. `usual` records are what there was room for at first.
template <typename Traits, int D, typename Insertion>
BaseCase<D> list_base_case(const BaseCaseInput<D>& input, const Insertion& insertion,
                           const typename Traits::WorkingPoints& points, std::size_t usual,
                           Slab& memory) {
  BaseCase<D> result;
  result.dimension = D;
  const std::uint32_t count = insertion.simplex_count();
  if constexpr (requires { insertion.forecast(); }) {
    if (input.memory != nullptr && !input.in_place && count > usual) {
      // The list, and what a merge makes of it.
      const std::uint64_t bytes = 2 * (count - usual) * sizeof(Simplex<D>);
      input.memory->grow(bytes, insertion.forecast());
    }
  }
  const auto list_as = [&](const auto& number, auto* made) {
    list_simplices<D>(result, count, points.safe_box.has_value(),
                      [&](std::uint32_t begin, std::uint32_t end, ListingNotes<D>& notes) {
                        if constexpr (D <= 3) {
                          list_range<Traits, D>(insertion.simplices(), begin, end, number,
                                                points.safe_box, made, notes);
                        } else {
                          list_range(insertion.simplices(), points, begin, end, number, made,
                                     notes);
                        }
                      });
  };
  const auto list = [&](const auto& number) {
    if (input.corners_only) {
      result.corners = make_corners<D>(memory, count);
      list_as(number, result.corners.data());
      if (count > usual) result.corners.release_rest();  // for what is made of them
    } else {
      result.simplices = make_list<D>(input, memory, count);
      list_as(number, result.simplices.data());
    }
  };
  constexpr std::uint32_t kUnit = Traits::kVertexUnit;
  const VertexId shift = input.first_vertex - kFirstPoint;
  if (insertion.repetitions().empty()) {
    list([shift](auto& v) { v = v / kUnit + shift; });
  } else {
    const std::vector<VertexId> kept = choose_kept<D>(input, insertion.repetitions());
    list([&](auto& v) { set_each(v, [&](VertexId word) { return kept[word / kUnit] + shift; }); });
    result.duplicates = list_duplicates(insertion.repetitions(), kept, input.first_vertex);
  }
  return result;
}

/// Triangulates points that span D dimensions; `basis` has the places of D+1 affinely independent
/// ones. What a kernel has of its own are its `Traits`:
/// - `kDimension`, and the `kRounds` of its insertion;
/// - `kMostPoints`, which it can number; more are refused;
/// - `WorkingPoints` (with `Row`, what a vertex takes), and `kMakePoints` to fill a slab with them;
/// - `Array`, its records by number: `Record`s with vertices, neighbours and a sphere of four
///   numbers, the `centre` first; room for usual_records() of so many points is made at first;
/// - `kVertexUnit`: records name a vertex by so many times its number;
/// - `Insertion<bool>` into an array that array_in() makes of a slab, and by_variant(), which
///   calls a function with std::true_type or std::false_type, what points ask for;
/// - up to three dimensions least_gap_squared() of two spheres, records of four numbers: what the
///   square of the distance from the computed centre to something must exceed if it is certainly
///   beyond the true sphere; in more a list_range() of its `Array`, which numbers vertices one by
///   one.
template <typename Traits>
auto incremental_base_case(const BaseCaseInput<Traits::kDimension>& input,
                           std::span<const VertexId> basis) {
  constexpr int kDimension = Traits::kDimension;
  const std::size_t count = input.points.size();
  if (count > Traits::kMostPoints) {
    throw Failure(fmt::format("a base case of {} points is more than can be numbered; choose base "
                              "cases of at most {} points",
                              count, Traits::kMostPoints),
                  ErrorCode::kTooLarge);
  }
  BorrowedSlab point_memory(SlabUse::kPoints,
                            (count + kFirstPoint) * sizeof(typename Traits::WorkingPoints::Row));
  const auto points = Traits::kMakePoints(input.points, *point_memory, input.safe_box);
  const std::size_t usual = Traits::usual_records(count);
  const std::size_t bytes = usual * sizeof(typename Traits::Record);
  BorrowedSlab records(SlabUse::kSimplices, bytes);
  records->reserve(bytes);
  std::array<VertexId, kDimension + 1> first;
  for (std::size_t i = 0; i < first.size(); ++i) first[i] = basis[i] + kFirstPoint;
  return Traits::by_variant(points, [&](auto variant) {
    typename Traits::template Insertion<decltype(variant)::value> insertion(
        points, Traits::array_in(*records, usual, input.memory), first, lane_width());
    insert_in_rounds(insertion, count, basis, Traits::kRounds);
    if constexpr (requires { insertion.close_gaps(); }) insertion.close_gaps();
    return list_base_case<Traits, kDimension>(input, insertion, points, usual, *records);
  });
}

}  // namespace spillway::delaunay::kernel
