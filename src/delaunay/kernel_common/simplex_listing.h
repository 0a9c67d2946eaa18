#pragma once
// How kernels turn their own records into a base case's simplices.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "src/delaunay/kernel_common/kernel.h"
#include "src/parallel/parallel.h"

namespace spillway::detail::kernel {

/// What is noted of simplices while they are listed: BaseCase::hull and BaseCase::not_inside.
struct ListingNotes {
  std::vector<std::uint32_t> hull;
  std::vector<std::uint32_t> not_inside;
};

/// Fills result.simplices, hull and, if `asked`, not_inside by calls of list(begin, end, notes) for
/// grains of simplices. After a first one come ranges as long as all before them, whose grains are
/// worked on at the same time by threads that have nothing else to do. The simplices may lie where
/// the kernel's records are, if those are at least twice as large and numbered alike: those of a
/// range come to lie over records before it, and those of the first grain, in which list() keeps to
/// the order and reads a record before it writes, over records that it has read.
template <int D, typename List>
void list_simplices(BaseCase<D>& result, bool asked, const List& list) {
  constexpr std::size_t kGrain = std::size_t{1} << 14;
  const std::size_t count = result.simplices.size();
  std::vector<ListingNotes> notes(grain_count(count, kGrain));
  for (std::size_t done = 0; done < count;) {
    const std::size_t end = std::min(count, std::max(kGrain, 2 * done));
    parallel_for(end - done, kGrain, [&](std::size_t g, std::size_t first, std::size_t last) {
      list(static_cast<std::uint32_t>(done + first), static_cast<std::uint32_t>(done + last),
           notes[done / kGrain + g]);
    });
    done = end;
  }
  if (asked) result.not_inside.emplace();
  for (const ListingNotes& some : notes) {
    result.hull.insert(result.hull.end(), some.hull.begin(), some.hull.end());
    if (!asked) continue;
    result.not_inside->insert(result.not_inside->end(), some.not_inside.begin(),
                              some.not_inside.end());
  }
}

}  // namespace spillway::detail::kernel
