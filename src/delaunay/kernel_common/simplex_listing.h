#pragma once
// How kernels turn their own records into a base case's simplices.

#include <algorithm>
#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <optional>
#include <type_traits>
#include <vector>

#include "src/delaunay/kernel_common/insertion_rounds.h"
#include "src/delaunay/kernel_common/kernel.h"
#include "src/delaunay/kernel_common/lanes.h"
#include "src/geometry/box.h"
#include "src/parallel/parallel.h"

namespace spillway::delaunay::kernel {

/// What is noted of simplices while they are listed: parts of a base case of the same names.
template <int D>
struct ListingNotes {
  std::vector<std::uint32_t> hull;
  std::vector<std::uint32_t> not_inside;
  std::vector<Simplex<D>> open_simplices;
  bool lists_open = true;  ///< whether open_simplices are wanted
};

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

/// The sides of a box in all lanes.
template <int D>
struct WideBox {
  std::array<Reals<2>, D> lo{};
  std::array<Reals<2>, D> hi{};

  explicit WideBox(const Box<D>& box) {
    for (int k = 0; k < D; ++k) {
      lo[k] = Reals<2>{box.lo[k], box.lo[k]};
      hi[k] = Reals<2>{box.hi[k], box.hi[k]};
    }
  }
};

/// A bit for each of two spheres: whether its centre, the first D numbers of its record, is inside
/// the box and the square of its distance to the nearest side, as computed, is above `least`.
template <int D>
SPILLWAY_INLINE std::uint32_t inside_by_more(const Records<2>& spheres, const Reals<2>& least,
                                             const WideBox<D>& box) {
  const auto lesser = [](const Reals<2>& a, const Reals<2>& b) { return a < b ? a : b; };
  const auto gap_along = [&](const Reals<2>& centre, int k) {
    return lesser(centre - box.lo[k], box.hi[k] - centre);
  };
  Reals<2> gap = lesser(gap_along(spheres.x, 0), gap_along(spheres.y, 1));
  if constexpr (D == 3) gap = lesser(gap, gap_along(spheres.z, 2));
  // Two masks: the compiler would join the comparisons lane by lane.
  return mask_of((Reals<2>)(gap > 0)) & mask_of((Reals<2>)(gap * gap > least));
}

/// Turns a range of a kernel's records into simplices, or into their corners; number() turns four
/// vertices into final ones. What is made may lie where the records are: see list_simplices.
/// `Traits` are those of incremental_base_case().
template <typename Traits, int D, typename Number, typename Made>
void list_range(const typename Traits::Array& records, std::uint32_t begin, std::uint32_t end,
                const Number& number, const std::optional<Box<D>>& safe_box, Made* made,
                ListingNotes<D>& notes) {
  constexpr std::uint32_t kAhead = 16;  // records are fetched so many ahead
  static_assert(sizeof(records.record(0)) >= 2 * sizeof(Simplex<D>),
                "they are listed over records");
  constexpr bool kCornersOnly = !std::is_same_v<Made, Simplex<D>>;
  const bool asked = safe_box.has_value();
  const WideBox<D> box(safe_box.value_or(Box<D>{}));
  const auto store_simplex = [](const Words& vertices, const Words& neighbours,
                                Simplex<D>& simplex) {
    std::memcpy(simplex.vertices.data(), &vertices, sizeof simplex.vertices);
    std::memcpy(simplex.neighbours.data(), &neighbours, sizeof simplex.neighbours);
  };
  const auto list = [&](std::uint32_t i, std::uint32_t inside) {
    const auto& record = records.record(i);
    Words vertices, neighbours;
    load(record.vertices, vertices);
    load(record.neighbours, neighbours);
    const Words infinite = (Words)(vertices == kInfinite);  // all bits, and so kInfiniteVertex
    number(vertices);
    vertices |= infinite;
    neighbours >>= Traits::Array::kNumberShift;
    if constexpr (kCornersOnly) {
      std::memcpy(made[i].data(), &vertices, sizeof made[i]);
    } else {
      store_simplex(vertices, neighbours, made[i]);
    }
    const bool finite = mask_of(infinite) == 0;
    if (!finite) notes.hull.push_back(i);
    if (!asked || (finite && inside != 0)) return;
    notes.not_inside.push_back(i);
    if (kCornersOnly && notes.lists_open) {
      store_simplex(vertices, neighbours, notes.open_simplices.emplace_back());
    }
  };
  for (std::uint32_t i = begin; i < end; i += 2) {
    const std::uint32_t last = std::min(i + 1, end - 1);
    for (const std::uint32_t ahead : {i, last}) __builtin_prefetch(&records.record(ahead + kAhead));
    std::uint32_t inside = 0;
    if (asked) {
      const auto spheres = gather<2>([&](std::uint32_t lane) -> const double* {
        return records.record(lane == 0 ? i : last).centre;
      });
      inside = inside_by_more<D>(spheres, Traits::least_gap_squared(spheres), box);
    }
    list(i, inside & 1);
    if (last != i) list(last, inside >> 1);
  }
}

}  // namespace spillway::delaunay::kernel
