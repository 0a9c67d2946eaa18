#pragma once
// How kernels turn their own records into a base case's simplices.

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "src/delaunay/kernel_common/kernel.h"
#include "src/parallel/parallel.h"

namespace spillway::detail::kernel {

/// What is noted of simplices while they are listed: parts of a base case of the same names.
template <int D>
struct ListingNotes {
  std::vector<std::uint32_t> hull;
  std::vector<std::uint32_t> not_inside;
  std::vector<Simplex<D>> open_simplices;
  bool lists_open = true;  ///< whether open_simplices are wanted
};

/// Where more than one simplex of so many is open they are not listed: that would take more memory
/// than it saves time.
constexpr std::size_t kFewestForOneOpen = 8;

/// Fills the simplices of a result, or their corners, and hull, and, if `asked`, not_inside and
/// open_simplices by calls of list(begin, end, notes) for grains of the `count` simplices. After a
/// first one come ranges as long as all before them, whose grains are worked on at the same time by
/// threads that have nothing else to do. The simplices may lie where the kernel's records are, if
/// those are at least twice as large and numbered alike: those of a range come to lie over records
/// before it, and those of the first grain, in which list() keeps to the order and reads a record
/// before it writes, over records that it has read.
template <int D, typename List>
void list_simplices(BaseCase<D>& result, std::size_t count, bool asked, const List& list) {
  constexpr std::size_t kGrain = std::size_t{1} << 14;
  std::vector<ListingNotes<D>> notes(grain_count(count, kGrain));
  std::atomic<std::size_t> open = 0;
  for (std::size_t done = 0; done < count;) {
    const std::size_t end = std::min(count, std::max(kGrain, 2 * done));
    parallel_for(end - done, kGrain, [&](std::size_t g, std::size_t first, std::size_t last) {
      ListingNotes<D>& mine = notes[done / kGrain + g];
      mine.lists_open = open <= count / kFewestForOneOpen;
      list(static_cast<std::uint32_t>(done + first), static_cast<std::uint32_t>(done + last), mine);
      open += mine.not_inside.size();
    });
    done = end;
  }
  const auto append = [](auto& all, const auto& some) {
    all.insert(all.end(), some.begin(), some.end());
  };
  for (const ListingNotes<D>& some : notes) append(result.hull, some.hull);
  if (!asked) return;
  result.not_inside.emplace().reserve(open);
  for (const ListingNotes<D>& some : notes) append(*result.not_inside, some.not_inside);
  if (open > count / kFewestForOneOpen) return;
  for (const ListingNotes<D>& some : notes) append(result.open_simplices, some.open_simplices);
}

}  // namespace spillway::detail::kernel
