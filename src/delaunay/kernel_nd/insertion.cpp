#include "src/delaunay/kernel_nd/insertion.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>

#include "src/delaunay/kernel_common/lanes.h"
#include "src/delaunay/kernel_nd/power_functions.h"
#include "src/error.h"
#include "src/geometry/dimensions.h"
#include "src/geometry/predicates.h"

namespace spillway::delaunay::kernel_nd {
namespace {

/// For each slot an even permutation of a simplex's vertices that ends with it.
template <int D>
constexpr auto kSlotsToLast = [] {
  std::array<std::array<std::uint8_t, D + 1>, D + 1> places{};
  for (int slot = 0; slot <= D; ++slot) {
    for (int i = 0; i <= D; ++i) places[slot][i] = static_cast<std::uint8_t>(i);
    if (slot == D) continue;
    std::swap(places[slot][slot], places[slot][D]);
    const int first = slot == 0 ? 1 : 0;  // two of the others
    std::swap(places[slot][first], places[slot][slot == first + 1 ? first + 2 : first + 1]);
  }
  return places;
}();

}  // namespace

template <int D>
Insertion<D>::Insertion(const WorkingPoints<D>& points, SimplexMemory<D> memory,
                        const std::array<VertexId, D + 1>& first, int width)
    : points_(points),
      memory_(memory),
      simplices_(memory_.first(D + 2)),
      width_(width),
      star_vertices_(points.count) {
  capacity_ = memory_.capacity();
  start(first);
}

/// The first simplex, and an infinite one at each of its facets.
template <int D>
void Insertion<D>::start(std::array<VertexId, D + 1> first) {
  if (orientation<D>(corners_of(first)) < 0) std::swap(first[0], first[1]);
  take_numbers(D + 2);
  for (int i = -1; i <= D; ++i) {
    Record& simplex = simplices_.record(i + 1);
    simplex.mark = 0;
    simplex.vertices = first;
    if (i < 0) continue;
    simplex.vertices[i] = kernel::kInfinite;
    // A point beyond the facet lies on the other side than the vertex that it is instead of.
    std::swap(simplex.vertices[i == 0 ? 1 : 0], simplex.vertices[i == D ? D - 1 : D]);
  }
  // All have D of these D + 2 vertices in common: each lacks one that all others have.
  for (std::uint32_t a = 0; a < D + 2; ++a) {
    for (std::uint32_t b = 0; b < a; ++b) {
      const auto facet_beside = [&](std::uint32_t one, std::uint32_t other) {
        int slot = 0;
        while (simplices_.record(other).slot_of(simplices_.record(one).vertices[slot]) <= D) ++slot;
        return SimplexArray<D>::facet(one, slot);
      };
      simplices_.join(facet_beside(a, b), facet_beside(b, a));
    }
  }
  star_on_hull_ = true;
  make_star_powers();
}

template <int D>
void Insertion<D>::insert(VertexId point, VertexId next) {
  const std::uint32_t first = locate(point);
  if (first == kNone) return;
  find_hole(point, first);
  take_numbers(boundary_.size());
  fill_hole(point);
  make_star_powers();
  free_hole();
  choose_hint(next);
}

template <int D>
SPILLWAY_INLINE bool Insertion<D>::is_in_conflict(const Record& simplex, VertexId query) const {
  const double value = simplex.power.value(points_.row(query));
  if (value < -simplex.power.tolerance) return true;
  if (value > simplex.power.tolerance) return false;
  return is_in_conflict_exactly(simplex, query);
}

/// The points that the caller gave.
template <int D>
std::array<Point<D>, D + 1> Insertion<D>::corners_of(
    const std::array<VertexId, D + 1>& vertices) const {
  std::array<Point<D>, D + 1> corners;
  for (int i = 0; i <= D; ++i) corners[i] = points_.original(vertices[i]);
  return corners;
}

/// The sign of the orientation of a simplex with the query instead of the vertex in a slot, by
/// exact predicates.
template <int D>
int Insertion<D>::orientation_with(const Record& simplex, int slot, VertexId query) const {
  std::array<VertexId, D + 1> vertices = simplex.vertices;
  vertices[slot] = query;
  return orientation<D>(corners_of(vertices));
}

template <int D>
[[gnu::noinline]] bool Insertion<D>::is_in_conflict_exactly(const Record& simplex,
                                                            VertexId query) const {
  if (const int slot = simplex.infinite_slot(); slot <= D) {
    const int side = orientation_with(simplex, slot, query);
    // In the hyperplane of the facet: in conflict if inside its sphere, as for the neighbour.
    return side != 0 ? side > 0 : is_in_conflict(simplices_.at(simplex.neighbours[slot]), query);
  }
  return in_sphere<D>(corners_of(simplex.vertices), points_.original(query)) > 0;
}

/// Finds a simplex in conflict with the query, or kNone if it equals a vertex; that is remembered.
/// From simplex to simplex the power of the query falls, so it comes to the one that contains it.
template <int D>
std::uint32_t Insertion<D>::locate(VertexId query) {
  const double* const row = points_.row(query);
  std::uint32_t here = hint_;
  double best = std::numeric_limits<double>::infinity();
  for (;;) {
    const Record& simplex = simplices_.record(here);
    const double value = simplex.power.value(row);
    if (value < -simplex.power.tolerance) return here;
    if (simplex.infinite()) return locate_exactly(query, here);
    best = std::min(best, value);
    std::uint32_t nearest = kNone;
    for (const Facet neighbour : simplex.neighbours) {
      const Record& other = simplices_.at(neighbour);
      const double there = other.power.value(row);
      if (there < -other.power.tolerance) return SimplexArray<D>::number(neighbour);
      if (other.power.curvature > 0 && there < best) {
        best = there;
        nearest = SimplexArray<D>::number(neighbour);
      }
    }
    if (nearest == kNone) return locate_exactly(query, here);
    here = nearest;
  }
}

/// The same with exact predicates: through facets beyond which the query lies.
template <int D>
[[gnu::noinline, gnu::cold]] std::uint32_t Insertion<D>::locate_exactly(VertexId query,
                                                                        std::uint32_t number) {
  if (const Record& start = simplices_.record(number); start.infinite()) {
    const int slot = start.infinite_slot();
    if (orientation_with(start, slot, query) > 0) return number;
    number = SimplexArray<D>::number(start.neighbours[slot]);
  }
  for (;;) {
    const Record& simplex = simplices_.record(number);
    if (simplex.infinite()) return number;
    int slot = 0;
    while (slot <= D && orientation_with(simplex, slot, query) >= 0) ++slot;
    if (slot > D) {
      for (const VertexId v : simplex.vertices) {
        if (points_.original(v) != points_.original(query)) continue;
        repetitions_.push_back({query, v});
        hint_ = number;
        return kNone;
      }
      return number;
    }
    number = SimplexArray<D>::number(simplex.neighbours[slot]);
  }
}

/// Without a branch on what a test finds, which nobody could predict.
template <int D>
void Insertion<D>::find_hole(VertexId query, std::uint32_t first) {
  search_ += 2;
  const double* const row = points_.row(query);
  hole_.assign(1, first);
  simplices_.record(first).mark = search_;
  std::size_t count = 1;
  std::size_t boundary_count = 0;
  for (std::size_t i = 0; i < count; ++i) {
    hole_.resize(std::max(hole_.size(), count + D + 1));
    boundary_.resize(std::max(boundary_.size(), boundary_count + D + 1));
    const std::uint32_t number = hole_[i];
    const Record& simplex = simplices_.record(number);
    for (int slot = 0; slot <= D; ++slot) {
      const std::uint32_t beside = SimplexArray<D>::number(simplex.neighbours[slot]);
      Record& other = simplices_.record(beside);
      if (other.mark < search_) {
        const double value = other.power.value(row);
        bool conflict = value < 0;
        if (!(std::abs(value) > other.power.tolerance)) [[unlikely]] {
          conflict = is_in_conflict_exactly(other, query);
        }
        hole_[count] = beside;
        count += static_cast<std::size_t>(conflict);
        other.mark = search_ + static_cast<std::uint32_t>(!conflict);
      }
      const bool conflict = other.mark == search_;
      boundary_[boundary_count] = SimplexArray<D>::facet(number, slot);
      boundary_count += static_cast<std::size_t>(!conflict);
    }
    if (i + kAhead < count) prefetch_neighbours(hole_[i + kAhead]);
  }
  hole_.resize(count);
  boundary_.resize(boundary_count);
}

/// Numbers for the new simplices, and room for them.
template <int D>
void Insertion<D>::take_numbers(std::size_t count) {
  star_.clear();
  const std::size_t reused = std::min(count, free_.size());
  star_.insert(star_.end(), free_.end() - static_cast<std::ptrdiff_t>(reused), free_.end());
  free_.resize(free_.size() - reused);
  const std::size_t wanted = count_ + (count - reused);
  if (wanted > capacity_) {
    if (wanted > SimplexArray<D>::kMostRecords) {
      throw Failure(fmt::format("a base case has more than {} simplices, more than can be "
                                "numbered; choose smaller base cases",
                                SimplexArray<D>::kMostRecords),
                    ErrorCode::kTooLarge);
    }
    simplices_ = memory_.grow(wanted, count_, forecast());
    capacity_ = memory_.capacity();
  }
  while (count_ < wanted) star_.push_back(count_++);
}

/// Makes the star's simplices, without their power functions, and joins them to those around.
template <int D>
void Insertion<D>::fill_hole(VertexId query) {
  star_vertices_.begin();
  star_numbers_.resize(std::max(star_numbers_.size(), boundary_.size()));
  star_on_hull_ = false;
  for (std::size_t i = 0; i < boundary_.size(); ++i) {
    const Facet facet = boundary_[i];
    const int point_slot = SimplexArray<D>::slot(facet);
    const Record& inner = simplices_.at(facet);
    Record& simplex = simplices_.record(star_[i]);
    const auto& places = kSlotsToLast<D>[point_slot];
    for (int slot = 0; slot < D; ++slot) {
      const VertexId v = inner.vertices[places[slot]];
      simplex.vertices[slot] = v;
      star_numbers_[i][slot] = star_vertices_.number(v);
      star_on_hull_ |= v == kernel::kInfinite;
    }
    simplex.vertices[D] = query;
    simplex.mark = 0;
    simplices_.join(SimplexArray<D>::facet(star_[i], D), inner.neighbours[point_slot]);
  }
  join_star();
}

/// Joins the star's simplices to each other.
template <int D>
void Insertion<D>::join_star() {
  const auto by_bits = [&]<typename Key>(RidgeTable<Key>& table) {
    join_star(table, [](const auto& numbers, const auto& visit) {
      for_each_ridge<Key, D>(numbers, visit);
    });
  };
  if (star_vertices_.count() <= 64) {
    by_bits(ridges_);
  } else if (star_vertices_.count() <= 128) {
    by_bits(wide_ridges_);
  } else {
    join_star(wide_ridges_, [](const auto& numbers, const auto& visit) {
      for_each_sorted_ridge<D>(numbers, visit);
    });
  }
}

template <int D>
template <typename Table, typename ForEachRidge>
SPILLWAY_INLINE void Insertion<D>::join_star(Table& table, const ForEachRidge& for_each) {
  table.begin(D * star_.size());
  for (std::size_t i = 0; i < star_.size(); ++i) {
    for_each(
        star_numbers_[i], [&](auto key, int slot) __attribute__((always_inline)) {
          // The first of two is its own neighbour until the other one comes.
          const Facet own = SimplexArray<D>::facet(star_[i], slot);
          simplices_.join(own, table.match(key, own));
        });
  }
}

template <int D>
void Insertion<D>::make_star_powers() {
  if (width_ >= 4) {
    make_star_powers_by_4();
  } else {
    make_powers<2, D>(points_, simplices_, star_, star_on_hull_);
  }
}

template <int D>
SPILLWAY_TARGET("avx2,bmi,bmi2")
void Insertion<D>::make_star_powers_by_4() {
  make_powers<4, D>(points_, simplices_, star_, star_on_hull_);
}

template <int D>
void Insertion<D>::free_hole() {
  for (const std::uint32_t number : hole_) simplices_.record(number).mark = Record::kFree;
  free_.insert(free_.end(), hole_.begin(), hole_.end());
}

/// The search for the next point begins at the simplex of the star in which its power is smallest.
template <int D>
void Insertion<D>::choose_hint(VertexId next) {
  const double* const row = points_.row(next);
  double best = std::numeric_limits<double>::infinity();
  hint_ = star_[0];
  for (const std::uint32_t number : star_) {
    const PowerFunction<D>& power = simplices_.record(number).power;
    const double value = power.value(row);
    if (power.curvature > 0 && value < best) {
      best = value;
      hint_ = number;
    }
  }
}

template <int D>
WorkForecast Insertion<D>::forecast() const {
  return WorkForecast::of(before_, sample_, D, SimplexMemory<D>::kBytesOfRecord);
}

template <int D>
void Insertion<D>::close_gaps() {
  // The last simplices that are in use go to the lowest free places.
  std::sort(free_.begin(), free_.end());
  std::size_t next_free = 0;
  const auto count = static_cast<std::uint32_t>(count_ - free_.size());
  for (std::uint32_t from = count_; from > count; --from) {
    const Record& simplex = simplices_.record(from - 1);
    if (simplex.mark == Record::kFree) continue;
    const std::uint32_t to = free_[next_free++];
    Record& moved = simplices_.record(to);
    moved = simplex;
    for (int slot = 0; slot <= D; ++slot) {
      simplices_.join(SimplexArray<D>::facet(to, slot), moved.neighbours[slot]);
    }
  }
  count_ = count;
  free_.clear();
}

#define SPILLWAY_INSTANTIATE(D) template class Insertion<D>;
SPILLWAY_FOR_EACH_HIGHER_DIMENSION(SPILLWAY_INSTANTIATE)
#undef SPILLWAY_INSTANTIATE

}  // namespace spillway::delaunay::kernel_nd
