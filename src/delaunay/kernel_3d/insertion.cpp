#include "src/delaunay/kernel_3d/insertion.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "src/delaunay/kernel_3d/exact_predicates.h"
#include "src/delaunay/kernel_3d/insertion_by_lanes.h"
#include "src/delaunay/kernel_3d/spheres.h"
#include "src/error.h"

namespace spillway::delaunay::kernel_3d {
namespace {

/// How far the query is outside of the cell's sphere: the difference of squares.
SPILLWAY_INLINE double power(const Cell& cell, const double* query) {
  const double x = query[0] - cell.centre[0];
  const double y = query[1] - cell.centre[1];
  const double z = query[2] - cell.centre[2];
  return x * x + y * y + z * z - cell.squared_radius;
}

}  // namespace

template <bool kHasOrderKeys>
Insertion<kHasOrderKeys>::Insertion(const WorkingPoints& points, CellMemory memory,
                                    const std::array<VertexId, 4>& first, int width)
    : points_(points),
      memory_(memory),
      cells_(memory_.first(kFirstListSize)),
      capacity_(memory_.capacity()),
      width_(width),
      star_maker_(points.count) {
  resize_lists(kFirstListSize);
  std::array<VertexRef, 4> v{ref(first[0]), ref(first[1]), ref(first[2]), ref(first[3])};
  if (orientation(points_, v) < 0) std::swap(v[2], v[3]);
  std::copy(v.begin(), v.end(), cells_.at_cell(0).vertices);
  star_[0] = 0;
  make_star_spheres<2>(v[0], v[0], 1, false);
  for (std::uint32_t k = 0; k < 4; ++k) {
    // The infinite cell beyond the facet opposite v[k].
    const auto& places = kPlaces[k];
    Cell& cell = cells_.record(1 + k);
    cell.vertices[0] = v[places[1]];
    cell.vertices[1] = kInfinite;
    cell.vertices[2] = v[places[2]];
    cell.vertices[3] = v[places[3]];
    make_half_space(cell);
    cells_.join(CellArray::facet(0, k), CellArray::facet(CellArray::cell(1 + k), 1));
  }
  const auto facet = [&](std::uint32_t k, std::uint32_t j) {
    const Handle cell = CellArray::cell(1 + k);
    const auto vertices = vertices_of(cells_.at_cell(cell));
    const auto slot = std::find(vertices.begin(), vertices.end(), v[j]) - vertices.begin();
    return CellArray::facet(cell, static_cast<std::uint32_t>(slot));
  };
  for (std::uint32_t k = 0; k < 4; ++k) {
    for (std::uint32_t j = 0; j < k; ++j) cells_.join(facet(k, j), facet(j, k));
  }
  known_conflicts_ = 0;
}

template <bool kHasOrderKeys>
void Insertion<kHasOrderKeys>::resize_lists(std::size_t size) {
  conflicts_.resize(size);
  boundary_.resize(size);
  outer_.resize(size);
  star_.resize(size);
}

/// Finds a cell in conflict with the query, or kNone if it equals a vertex; that is remembered.
/// From cell to cell the power of the query falls, so it comes to the cell that contains it.
template <bool kHasOrderKeys>
Handle Insertion<kHasOrderKeys>::locate(VertexRef query) {
  const double* q = points_.at(query);
  Handle here = hint_;
  const Cell* cell = &cells_.at_cell(here);
  double best = power(*cell, q);
  if (best < -tolerance_of(cell->squared_radius)) return here;
  for (;;) {
    Handle nearest = kNone;
    for (const Handle neighbour : cell->neighbours) {
      const Handle there = CellArray::cell_of(neighbour);
      const Cell& other = cells_.at_cell(there);
      const double s = power(other, q);
      if (s < -tolerance_of(other.squared_radius)) return there;
      if (s < best) {
        best = s;
        nearest = there;
      }
    }
    if (nearest == kNone) return locate_exactly(query, here);
    here = nearest;
    cell = &cells_.at_cell(here);
  }
}

/// The same with exact predicates.
template <bool kHasOrderKeys>
[[gnu::noinline, gnu::cold]] Handle Insertion<kHasOrderKeys>::locate_exactly(VertexRef query,
                                                                             Handle first) {
  std::array<VertexRef, 4> start = vertices_of(cells_.at_cell(first));
  if (const std::size_t k = infinite_slot(start); k < 4) {
    start[k] = query;
    if (orientation(points_, start) > 0) return first;
    first = CellArray::cell_of(cells_.at_cell(first).neighbours[k]);
  }
  for (;;) {
    const Cell& cell = cells_.at_cell(first);
    const std::array<VertexRef, 4> vertices = vertices_of(cell);
    std::size_t k = 0;
    for (; k < 4; ++k) {
      std::array<VertexRef, 4> replaced = vertices;
      replaced[k] = query;
      if (orientation(points_, replaced) < 0) break;
    }
    if (k == 4) {
      for (const VertexRef v : vertices) {
        if (points_.original(v) != points_.original(query)) continue;
        repetitions_.push_back({query / 4, v / 4});
        hint_ = first;
        return kNone;
      }
      return first;
    }
    first = CellArray::cell_of(cell.neighbours[k]);
    if (infinite_slot(vertices_of(cells_.at_cell(first))) < 4) return first;
  }
}

/// Whether the query is in conflict with a cell of which no tie is noted, by the upper stages.
template <bool kHasOrderKeys>
bool Insertion<kHasOrderKeys>::conflicts(Handle first, VertexRef query) const {
  const Cell* cell = &cells_.at_cell(first);
  std::array<VertexRef, 4> vertices = vertices_of(*cell);
  if (const std::size_t k = infinite_slot(vertices); k < 4) {
    vertices[k] = query;
    const int side = orientation(points_, vertices);
    if (side != 0) return side > 0;
    // In the plane of the facet: in conflict if inside its circle, as for the neighbour.
    cell = &cells_.at(cell->neighbours[k]);
    vertices = vertices_of(*cell);
    const double s = power(*cell, points_.at(query));
    const double tolerance = tolerance_of(cell->squared_radius);
    if (s > tolerance) return false;
    if (s < -tolerance) return true;
    if (tie_is_noted(*cell)) return noted_tie_conflicts<2>(*cell, query);
  }
  const Five five{vertices, query};
  const int side = side_of_sphere(points_, five, cell->centre);
  return side != 0 ? side > 0 : tie_conflicts(points_, five);
}

template <bool kHasOrderKeys>
[[gnu::noinline, gnu::cold]] void Insertion<kHasOrderKeys>::grow_cells(std::size_t count) {
  if (count > CellArray::kMostRecords) {
    throw Failure(
        fmt::format("a base case of {} points has more than {} cells, more than can be numbered; "
                    "choose smaller base cases",
                    points_.count - 1, CellArray::kMostRecords),
        ErrorCode::kTooLarge);
  }
  cells_ = memory_.grow(count, cell_count_, forecast());
  capacity_ = memory_.capacity();
}

template <bool kHasOrderKeys>
WorkForecast Insertion<kHasOrderKeys>::forecast() const {
  return WorkForecast::of(before_, sample_, 3, CellMemory::kBytesOfRecord);
}

/// The half-spaces of the star's infinite cells. Those in conflict with the next point join the
/// `known` ones; returns how many there are then.
template <bool kHasOrderKeys>
[[gnu::noinline]] std::size_t Insertion<kHasOrderKeys>::make_half_spaces(VertexRef next,
                                                                         std::size_t count,
                                                                         std::size_t known) {
  for (std::size_t i = 0; i < count; ++i) {
    Cell& cell = cells_.at_cell(star_[i]);
    if (infinite_slot(vertices_of(cell)) == 4) continue;
    make_half_space(cell);
    const double s = power(cell, points_.at(next));
    if (s < -tolerance_of(cell.squared_radius)) conflicts_[known++] = star_[i];
  }
  return known;
}

template <bool kHasOrderKeys>
void Insertion<kHasOrderKeys>::make_half_space(Cell& cell) const {
  const std::size_t k = infinite_slot(vertices_of(cell));
  const double* anchor = points_.at(cell.vertices[0]);
  const auto edge = [&](std::size_t slot) {
    const double* end = points_.at(cell.vertices[slot]);
    return Point<3>{end[0] - anchor[0], end[1] - anchor[1], end[2] - anchor[2]};
  };
  const auto length = [](const Point<3>& v) {
    return std::abs(v[0]) + std::abs(v[1]) + std::abs(v[2]);
  };
  const Point<3> a = edge(k % 3 + 1);
  const Point<3> b = edge((k + 1) % 3 + 1);
  const double edges = length(a) * length(b);
  Point<3> normal{a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
  const auto scale_normal = [&normal](double scale) {
    for (double& c : normal) c *= scale;
    return normal[0] * normal[0] + normal[1] * normal[1] + normal[2] * normal[2];
  };
  const double radius = kBallOfHalfSpace * points_.extent;
  const double exact = scale_normal(radius / edges);
  const double tolerance = kHalfSpaceTolerance * points_.extent * points_.extent +
                           kToleranceOfPlace * radius * points_.largest;
  const std::int64_t exponent = (std::bit_cast<std::int64_t>(tolerance) >> kMantissaBits) + 1;
  const double carrying =
      std::bit_cast<double>((std::bit_cast<std::int64_t>(exact) & ~kCarriedMask) | exponent);
  // The radius has fewer bits than it needs; the normal is fitted to it.
  scale_normal(1 - (exact - carrying) / (2 * exact));
  for (std::size_t i = 0; i < 3; ++i) cell.centre[i] = anchor[i] + normal[i];
  cell.squared_radius =
      edges >= kSmallestEdges ? carrying : std::numeric_limits<double>::quiet_NaN();
}

/// The search for the next point begins at the cell of the star in which its power is smallest.
template <bool kHasOrderKeys>
[[gnu::noinline]] void Insertion<kHasOrderKeys>::choose_hint(const double* next,
                                                             std::size_t count) {
  double best = std::numeric_limits<double>::infinity();
  hint_ = star_[0];
  for (std::size_t i = 0; i < count; ++i) {
    const double s = power(cells_.at_cell(star_[i]), next);
    if (s < best) {
      best = s;
      hint_ = star_[i];
    }
  }
}

template <bool kHasOrderKeys>
void Insertion<kHasOrderKeys>::insert_by_2(VertexRef query, VertexRef next) {
  insert_by<2>(query, next);
}

template <bool kHasOrderKeys>
void Insertion<kHasOrderKeys>::insert(VertexId point, VertexId next) {
  if (width_ == 8) {
    insert_by_4_with_32_registers(ref(point), ref(next));
  } else if (width_ == 4) {
    insert_by_4(ref(point), ref(next));
  } else {
    insert_by_2(ref(point), ref(next));
  }
}

template <bool kHasOrderKeys>
void Insertion<kHasOrderKeys>::close_gaps() {
  // The last cells that are in use go to the lowest free places.
  std::sort(free_.data(), free_.data() + free_count_);
  std::size_t next_free = 0;
  const std::size_t count = cell_count_ - free_count_;
  for (std::uint32_t from = cell_count_; from > count; --from) {
    const Cell& cell = cells_.record(from - 1);
    if ((cell.vertices[3] & kMark) != 0) continue;
    const Handle to = free_[next_free++];
    Cell& moved = cells_.at_cell(to);
    moved = cell;
    for (std::uint32_t k = 0; k < 4; ++k) cells_.join(CellArray::facet(to, k), moved.neighbours[k]);
  }
  cell_count_ = static_cast<std::uint32_t>(count);
  free_count_ = 0;
}

template class Insertion<false>;
template class Insertion<true>;

}  // namespace spillway::delaunay::kernel_3d
