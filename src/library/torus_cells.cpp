#include "src/library/torus_cells.h"

#include <algorithm>
#include <atomic>
#include <limits>
#include <mutex>

#include "src/geometry/dimensions.h"
#include "src/geometry/torus_simplex.h"
#include "src/parallel/parallel.h"

namespace spillway::library {
namespace {

constexpr std::size_t kGrain = std::size_t{1} << 12;

/// Some corners of a cell as those of all of its copies: in the order of their coordinates, which is
/// the same for all, each by its point and by the periods between it and the first.
template <int D, class Index, int Count>
struct CornersKey {
  std::array<Index, Count> points;
  std::array<Periods<D>, Count> periods;

  auto operator<=>(const CornersKey&) const = default;  // NOLINT(modernize-use-nullptr)
};

/// What is known of a cell of the copies.
enum CellFlags : std::uint8_t {
  kChosen = 1,    ///< its centre is in the box
  kMeetsBox = 2,  ///< the box around it meets the torus' box
  kInBox = 4,     ///< all its corners are in the box
};

/// By axis, from where to where a cell goes.
template <int D>
struct Reach {
  Point<D> low, high;

  explicit Reach(const std::array<Point<D>, D + 1>& corners) : low(corners[0]), high(corners[0]) {
    for (const Point<D>& corner : corners) {
      for (int k = 0; k < D; ++k) {
        low[k] = std::min(low[k], corner[k]);
        high[k] = std::max(high[k], corner[k]);
      }
    }
  }
};

template <int D, class Index>
class Chooser {
 public:
  Chooser(const PeriodicDomain& domain, const CopiesView<D, Index>& copies)
      : domain_(domain),
        torus_(domain.torus()),
        mesh_(copies.mesh),
        points_(copies.points),
        point_of_(copies.point_of),
        flags_(mesh_.vertices.size() / (D + 1)) {}

  TorusCells<D, Index> choose() && {
    judge_cells();
    number_chosen();
    if (too_narrow_ || !match_copies() || !list_cells()) return std::move(result_);
    list_hull();
    list_vertex_cells();
    result_.proven = true;
    return std::move(result_);
  }

 private:
  using Corners = std::array<Point<D>, D + 1>;

  /// A chosen cell, or a copy of one that meets the box.
  struct CopyEntry {
    CornersKey<D, Index, D + 1> key;
    Index cell;  ///< of the copies
    int others;  ///< of a chosen one: so many copies of it meet the box; of a copy -1
  };
  /// A facet of a chosen cell behind which no chosen one lies.
  struct FacetEntry {
    CornersKey<D, Index, D> key;
    Index cell;  ///< of the result
    int place;
  };

  void judge_cells() {
    std::mutex mutex;  // guards the reach of all
    parallel_for(flags_.size(), kGrain, [&](std::size_t, std::size_t begin, std::size_t end) {
      std::array<double, 3> reach{};
      for (std::size_t c = begin; c < end; ++c) judge(c, reach);
      const std::lock_guard lock(mutex);
      for (int k = 0; k < D; ++k) result_.reach[k] = std::max(result_.reach[k], reach[k]);
    });
  }

  void judge(std::size_t c, std::array<double, 3>& longest) {
    const Corners corners = mesh_.corners(static_cast<Index>(c));
    const Reach<D> reach(corners);
    bool meets = true;
    bool in_box = true;
    bool at_side = false;
    for (int k = 0; k < D; ++k) {
      if (!torus_.periodic(k)) continue;
      const double low = torus_.low(k);
      const double high = torus_.high(k);
      meets &= reach.high[k] >= low && reach.low[k] < high;
      in_box &= reach.low[k] >= low && reach.high[k] < high;
      at_side |= reach.low[k] <= low || reach.high[k] >= high;
    }
    std::uint8_t flags = (meets ? kMeetsBox : 0) | (in_box ? kInBox : 0);
    const SimplexPlace<D> place = place_simplex<D>(torus_, corners);
    if (place.stands_for_all()) {
      flags |= kChosen;
      for (int k = 0; k < D; ++k) {
        if (torus_.periodic(k)) longest[k] = std::max(longest[k], reach.high[k] - reach.low[k]);
      }
      if (!domain_.has_sphere(place) || (at_side && !is_within_margin(place.radius))) {
        too_narrow_ = true;
      }
    }
    flags_[c] = flags;
  }

  /// A place in a cell is no farther from the nearest corner than the radius. So if no cell at a
  /// side has a larger one than the margin, the nearest point to a place in the box is among the
  /// copies: the ball around the place up to it would else, moved to the side, be too large there.
  [[nodiscard]] bool is_within_margin(double radius) const {
    return domain_.widest() || radius <= domain_.margin();
  }

  void number_chosen() {
    result_.number.assign(flags_.size(), -1);
    for (std::size_t c = 0; c < flags_.size(); ++c) {
      if ((flags_[c] & kChosen) == 0) continue;
      result_.number[c] = static_cast<Index>(result_.kept.size());
      result_.kept.push_back(static_cast<Index>(c));
    }
  }

  template <int Count>
  CornersKey<D, Index, Count> key_of(const std::array<Index, Count>& sorted) const {
    CornersKey<D, Index, Count> key;
    Periods<D> first{};
    for (int i = 0; i < Count; ++i) {
      key.points[i] = point_of_[sorted[i]];
      key.periods[i] = torus_.periods_of<D>(mesh_.points[sorted[i]]);
      if (i == 0) first = key.periods[0];
      key.periods[i] = less(key.periods[i], first);
    }
    return key;
  }

  static Periods<D> less(Periods<D> a, const Periods<D>& b) {
    for (int k = 0; k < D; ++k) a[k] = static_cast<std::int8_t>(a[k] - b[k]);
    return a;
  }

  std::array<Index, D + 1> sorted_vertices(Index cell, const SortedCorners<D>& sorted) const {
    std::array<Index, D + 1> vertices;
    for (int i = 0; i <= D; ++i) vertices[i] = mesh_.vertex(cell, sorted.order[i]);
    return vertices;
  }

  /// How many copies of a cell, which is none of them, meet the box.
  [[nodiscard]] int copies_in_box(const Reach<D>& reach) const {
    int all = 1;
    bool self = true;
    for (int k = 0; k < D; ++k) {
      if (!torus_.periodic(k)) continue;
      int count = 0;
      for (const int periods : {-1, 0, 1}) {
        const double shift = periods * torus_.period(k);
        const bool meets =
            reach.high[k] + shift >= torus_.low(k) && reach.low[k] + shift < torus_.high(k);
        count += meets ? 1 : 0;
        if (periods == 0) self &= meets;
      }
      all *= count;
    }
    return all - (self ? 1 : 0);
  }

  /// Finds the chosen cells that others which meet the box are copies of. False if some are missing.
  bool match_copies() {
    std::vector<CopyEntry> entries;
    for (std::size_t c = 0; c < flags_.size(); ++c) {
      const bool chosen = (flags_[c] & kChosen) != 0;
      if (chosen ? (flags_[c] & kInBox) != 0 : (flags_[c] & kMeetsBox) == 0) continue;
      const auto cell = static_cast<Index>(c);
      const Corners corners = mesh_.corners(cell);
      entries.push_back({key_of<D + 1>(sorted_vertices(cell, SortedCorners<D>(corners))), cell,
                         chosen ? copies_in_box(Reach<D>(corners)) : -1});
    }
    // The chosen one of a key comes first.
    std::sort(entries.begin(), entries.end(), [](const CopyEntry& a, const CopyEntry& b) {
      return a.key != b.key ? a.key < b.key : a.others > b.others;
    });
    for (std::size_t first = 0, next = 0; first < entries.size(); first = next) {
      while (next < entries.size() && entries[next].key == entries[first].key) ++next;
      if (entries[first].others < 0) continue;  // only the box around it meets the torus'
      if (next - first != static_cast<std::size_t>(entries[first].others) + 1) {
        if (!domain_.widest()) return false;
        list_missing(entries[first].cell);
        continue;
      }
      for (std::size_t e = first + 1; e < next; ++e) {
        if (entries[e].others >= 0) return false;
        result_.number[entries[e].cell] = result_.number[entries[first].cell];
      }
    }
    return result_.missing.empty();
  }

  /// The corners of all copies of a chosen cell that meet the box. That is exact: none lies farther
  /// from the box than a period.
  void list_missing(Index cell) {
    const Corners corners = mesh_.corners(cell);
    int copies = 1;
    for (int k = 0; k < D; ++k) copies *= 3;
    for (int n = 0; n < copies; ++n) {
      Periods<D> periods{};
      for (int k = 0, rest = n; k < D; ++k, rest /= 3) {
        periods[k] = static_cast<std::int8_t>(rest % 3 - 1);
      }
      Corners moved;
      for (int i = 0; i <= D; ++i) moved[i] = torus_.moved<D>(corners[i], periods);
      if (periods == Periods<D>{} || !meets_box(Reach<D>(moved), periods)) continue;
      for (int i = 0; i <= D; ++i) {
        result_.missing.push_back(moved[i]);
        result_.missing_of.push_back(point_of_[mesh_.vertex(cell, i)]);
      }
    }
  }

  /// Along open axes nothing is moved.
  [[nodiscard]] bool meets_box(const Reach<D>& reach, const Periods<D>& periods) const {
    for (int k = 0; k < D; ++k) {
      if (!torus_.periodic(k) && periods[k] != 0) return false;
      if (!torus_.periodic(k)) continue;
      if (reach.high[k] < torus_.low(k) || reach.low[k] >= torus_.high(k)) return false;
    }
    return true;
  }

  /// Corners, offsets and neighbours of the chosen cells. False if one has no neighbour.
  bool list_cells() {
    const std::size_t count = result_.kept.size();
    result_.cells.vertices = SlabArray<Index>(count * (D + 1));
    result_.cells.neighbours = SlabArray<Index>(count * (D + 1));
    result_.offsets = SlabArray<std::int8_t>(count * (D + 1) * D);
    std::vector<FacetEntry> facets;
    std::mutex mutex;  // guards facets
    parallel_for(count, kGrain, [&](std::size_t, std::size_t begin, std::size_t end) {
      std::vector<FacetEntry> some;
      for (std::size_t n = begin; n < end; ++n) list_cell(n, some);
      const std::lock_guard lock(mutex);
      facets.insert(facets.end(), some.begin(), some.end());
    });
    return !too_narrow_ && join(facets);
  }

  void list_cell(std::size_t n, std::vector<FacetEntry>& facets) {
    const Index cell = result_.kept[n];
    const Corners corners = mesh_.corners(cell);
    const SortedCorners<D> sorted(corners);
    std::array<Periods<D>, D + 1> periods;
    bool differ = false;
    for (int i = 0; i <= D; ++i) {
      periods[i] = torus_.periods_of<D>(corners[i]);
      differ |= periods[i] != periods[0];
    }
    for (int i = 0; i <= D; ++i) {
      const std::size_t place = n * (D + 1) + i;
      result_.cells.vertices[place] = point_of_[mesh_.vertex(cell, i)];
      const Periods<D> offset = differ ? less(periods[i], periods[sorted.order[0]]) : Periods<D>{};
      std::copy(offset.begin(), offset.end(), &result_.offsets[place * D]);
      result_.cells.neighbours[place] = -1;
      const Index neighbour = mesh_.neighbour(cell, i);
      if (neighbour >= 0 && (flags_[neighbour] & kChosen) != 0) {
        result_.cells.neighbours[place] = result_.number[neighbour];
        continue;
      }
      std::array<Index, D> facet;
      std::array<Point<D>, D> seen;
      for (int j = 0, f = 0; j <= D; ++j) {
        if (sorted.order[j] == i) continue;
        facet[f] = mesh_.vertex(cell, sorted.order[j]);
        seen[f++] = corners[sorted.order[j]];
      }
      if (neighbour < 0 && is_along_periods<D>(torus_, seen)) continue;
      facets.push_back({key_of<D>(facet), static_cast<Index>(n), i});
    }
  }

  bool join(std::vector<FacetEntry>& facets) {
    std::sort(facets.begin(), facets.end(),
              [](const FacetEntry& a, const FacetEntry& b) { return a.key < b.key; });
    if (facets.size() % 2 != 0) return false;
    for (std::size_t f = 0; f < facets.size(); f += 2) {
      const FacetEntry& a = facets[f];
      const FacetEntry& b = facets[f + 1];
      if (a.key != b.key || (f + 2 < facets.size() && facets[f + 2].key == a.key)) return false;
      result_.cells.neighbours[static_cast<std::size_t>(a.cell) * (D + 1) + a.place] = b.cell;
      result_.cells.neighbours[static_cast<std::size_t>(b.cell) * (D + 1) + b.place] = a.cell;
    }
    return true;
  }

  void list_hull() {
    std::vector<Index> cells;
    std::vector<Index> facets;
    if (!torus_.closed()) {
      for (std::size_t n = 0; n < result_.kept.size(); ++n) {
        for (int i = 0; i <= D; ++i) {
          if (result_.cells.neighbours[n * (D + 1) + i] >= 0) continue;
          cells.push_back(static_cast<Index>(n));
          for (const int place : facet_places<D>(i)) {
            facets.push_back(result_.cells.vertices[n * (D + 1) + place]);
          }
        }
      }
    }
    result_.cells.hull_cells = SlabArray<Index>(cells.size());
    std::copy(cells.begin(), cells.end(), result_.cells.hull_cells.begin());
    result_.cells.hull_facets = SlabArray<Index>(facets.size());
    std::copy(facets.begin(), facets.end(), result_.cells.hull_facets.begin());
  }

  void list_vertex_cells() {
    SlabArray<Index>& lowest = result_.cells.vertex_cells;
    lowest = SlabArray<Index>(points_, -1);
    for (std::size_t n = result_.kept.size(); n-- > 0;) {
      for (int i = 0; i <= D; ++i) {
        lowest[result_.cells.vertices[n * (D + 1) + i]] = static_cast<Index>(n);
      }
    }
  }

  const PeriodicDomain& domain_;
  const Torus& torus_;
  const MeshView<D, Index>& mesh_;
  const std::size_t points_;
  const std::span<const Index> point_of_;
  std::vector<std::uint8_t> flags_;  ///< CellFlags, by cell of the copies
  std::atomic<bool> too_narrow_ = false;
  TorusCells<D, Index> result_;
};

}  // namespace

template <int D, class Index>
TorusCells<D, Index> choose_torus_cells(const PeriodicDomain& domain,
                                        const CopiesView<D, Index>& copies) {
  return Chooser<D, Index>(domain, copies).choose();
}

#define SPILLWAY_INSTANTIATE(D)                                                                \
  template TorusCells<D, std::int32_t> choose_torus_cells(const PeriodicDomain&,               \
                                                          const CopiesView<D, std::int32_t>&); \
  template TorusCells<D, std::int64_t> choose_torus_cells(const PeriodicDomain&,               \
                                                          const CopiesView<D, std::int64_t>&);
SPILLWAY_FOR_EACH_CUT_DIMENSION(SPILLWAY_INSTANTIATE)
#undef SPILLWAY_INSTANTIATE

}  // namespace spillway::library
