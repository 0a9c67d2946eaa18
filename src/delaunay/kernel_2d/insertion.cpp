#include "src/delaunay/kernel_2d/insertion.h"

#include <algorithm>
#include <cmath>

#include "src/delaunay/kernel_2d/exact_predicates.h"

// Small functions of the inner loop, which the compiler would call rather than inline.
#define SPILLWAY_INLINE [[gnu::always_inline]] inline

namespace spillway::kernel_2d {
namespace {

using Triangles = TriangleArray;

constexpr std::size_t kFirstStackSize = 256;
/// Squares below this may belong to equal points.
constexpr double kSuspiciousSquare = 0x1p-900;
constexpr Handle kNone = ~Handle{0};

[[gnu::noinline, gnu::cold]] bool conflicts_by_upper_rungs(const WorkingPoints& points,
                                                           const Quad& quad) {
  return conflicts(points, quad);
}

}  // namespace

template <bool kLattice>
Insertion<kLattice>::Insertion(const WorkingPoints& points, TriangleArray triangles,
                               const std::array<VertexId, 3>& first)
    : points_(points), triangles_(triangles), open_(kFirstStackSize), free_(kFirstStackSize) {
  std::array<VertexId, 3> v = first;
  if (side_of_line(points_, v[0], v[1], v[2]) < 0) std::swap(v[1], v[2]);
  for (std::uint32_t i = 0; i < 3; ++i) {
    // Triangle 1 + i is the infinite one beyond the edge opposite v[i].
    triangles_.set_vertex(Triangles::handle(0, i), v[i]);
    triangles_.set_vertex(Triangles::handle(1 + i, 0), kInfinite);
    triangles_.set_vertex(Triangles::handle(1 + i, 1), v[(i + 2) % 3]);
    triangles_.set_vertex(Triangles::handle(1 + i, 2), v[(i + 1) % 3]);
    triangles_.join(Triangles::handle(0, i), Triangles::handle(1 + i, 0));
    triangles_.join(Triangles::handle(1 + i, 1), Triangles::handle(1 + (i + 2) % 3, 2));
  }
}

/// Whether the query lies to the right of the edge from the vertex at handle a to that at b.
template <bool kLattice>
SPILLWAY_INLINE bool Insertion<kLattice>::certainly_right(double cross_product, double largest,
                                                          Handle a, Handle b) const {
  if (kLattice && largest <= kExactCross) return cross_product < 0;
  const double bound = cross_bound(largest);
  if (cross_product > bound) return false;
  if (cross_product < -bound) return true;
  return side_of_line(points_, triangles_.vertex(a), triangles_.vertex(b), query_vertex_) < 0;
}

/// Finds a triangle in conflict with the query: the hint itself, if it is certainly one, or the one
/// that contains the query.
template <bool kLattice>
SPILLWAY_INLINE auto Insertion<kLattice>::locate(const Sight& sight) const -> Found {
  const Handle h = Triangles::handle(hint_, 0);
  const Corner a = sight.corner(triangles_.vertex(h));
  const Corner b = sight.corner(triangles_.vertex(h + 1));
  const Corner c = sight.corner(triangles_.vertex(h + 2));
  const double ab = cross(a, b);
  const double bc = cross(b, c);
  const double ca = cross(c, a);
  const double determinant = a.square * bc + b.square * ca + c.square * ab;
  const double largest = largest_square(a, b, c);
  Found found{.corners = {a, b, c},
              .edges = {triangles_.mirror(h), triangles_.mirror(h + 1), triangles_.mirror(h + 2)},
              .crosses = {bc, ca, ab},
              .triangle = hint_,
              .certain = determinant > in_circle_bound(largest)};
  if (found.certain) return found;
  if (certainly_right(bc, largest, h + 1, h + 2)) {
    walk(sight, found, b, c, bc, found.edges[0]);
  } else if (certainly_right(ab, largest, h, h + 1)) {
    walk(sight, found, a, b, ab, found.edges[2]);
  } else if (certainly_right(ca, largest, h + 2, h)) {
    walk(sight, found, c, a, ca, found.edges[1]);
  }
  return found;
}

/// Walks to the query through edges u -> v that have it on their right side; `edge` is that of the
/// triangle beyond.
template <bool kLattice>
void Insertion<kLattice>::walk(const Sight& sight, Found& found, Corner u, Corner v,
                               double cross_uv, Handle edge) const {
  for (;;) {
    const VertexId apex = triangles_.vertex(edge);
    const Corner w = sight.corner(apex);
    const Handle at_v = Triangles::next(edge);
    const Handle at_u = Triangles::previous(edge);
    const double uw = cross(u, w);
    const double wv = cross(w, v);
    const double largest = largest_square(u, v, w);
    if (apex != kInfinite && certainly_right(uw, largest, at_u, edge)) {
      edge = triangles_.mirror(at_v);
      v = w;
      cross_uv = uw;
    } else if (apex != kInfinite && certainly_right(wv, largest, edge, at_v)) {
      edge = triangles_.mirror(at_u);
      u = w;
      cross_uv = wv;
    } else {
      found.corners = {w, v, u};
      found.edges = {triangles_.mirror(edge), triangles_.mirror(at_v), triangles_.mirror(at_u)};
      found.crosses = {-cross_uv, uw, wv};
      found.triangle = Triangles::triangle_of(edge);
      return;
    }
  }
}

/// Whether the query equals a vertex of the triangle that contains it; if so, that is remembered.
template <bool kLattice>
bool Insertion<kLattice>::repeats_vertex(const Found& found) {
  for (std::uint32_t i = 0; i < 3; ++i) {
    if (!(found.corners[i].square <= kSuspiciousSquare)) continue;
    // Corner i is opposite edge i.
    const VertexId v = triangles_.vertex(triangles_.mirror(found.edges[i]));
    if (points_.original(v) == points_.original(query_vertex_)) {
      repetitions_.push_back({query_vertex_, v});
      return true;
    }
  }
  return false;
}

/// The sign of an in-circle determinant that the static filter leaves open.
template <bool kLattice>
SPILLWAY_INLINE bool Insertion<kLattice>::decide(const Open& open, const Corner& from,
                                                 double determinant) const {
  const double largest = largest_square(from, open.to, open.apex);
  if (kLattice && largest <= kExactInCircle) {
    if (determinant == 0) return tie_conflicts(from, open.to, open.apex);
    if (determinant == determinant) return determinant > 0;
  } else if (std::abs(determinant) > in_circle_bound(largest)) {
    return determinant > 0;
  }
  return conflicts_by_upper_rungs(
      points_, {triangles_.vertex(Triangles::previous(open.edge)), triangles_.vertex(open.edge),
                triangles_.vertex(Triangles::next(open.edge)), query_vertex_});
}

/// Looks at the triangle beyond an edge.
template <bool kLattice>
SPILLWAY_INLINE auto Insertion<kLattice>::look(const Sight& sight, const Corner& from,
                                               const Corner& to, double cross_from_to,
                                               Handle edge) const -> Open {
  Open open;
  open.to = to;
  open.apex = sight.corner(triangles_.vertex(edge));
  open.crosses = crosses_with(from, to, open.apex);
  open.edge = edge;
  const double determinant = to.square * open.crosses[0] - from.square * open.crosses[1] -
                             open.apex.square * cross_from_to;
  open.conflict = determinant > 0;
  if (!(std::abs(determinant) > sight.certain_determinant)) [[unlikely]] {
    open.conflict = decide(open, from, determinant);
  }
  return open;
}

/// Removes the triangles in conflict and fills the hole with those at the query.
template <bool kLattice>
SPILLWAY_INLINE void Insertion<kLattice>::dig(const Sight& sight, const Found& found,
                                              VertexId next) {
  const Pair towards = pair_of(sight.scaled[next]) - sight.query;
  const Pair direction{towards[1], -towards[0]};
  const auto side_of = [&direction](const Corner& c) {
    const Pair products = c.at * direction;
    return products[0] + products[1];
  };
  const TriangleArray triangles = triangles_;
  const VertexId query_vertex = query_vertex_;
  std::uint32_t* free = free_.data();
  Open* open = open_.data();
  std::size_t stack_size = open_.size();
  free[0] = Triangles::handle(triangle_count_ + 1, 0);
  free[1] = Triangles::handle(triangle_count_, 0);
  free[2] = Triangles::handle(found.triangle, 0);
  std::size_t free_count = 3;
  triangle_count_ += 2;

  const auto& corners = found.corners;
  open[0] = look(sight, corners[0], corners[1], found.crosses[2], found.edges[2]);
  open[1] = look(sight, corners[2], corners[0], found.crosses[1], found.edges[1]);
  Open now = look(sight, corners[1], corners[2], found.crosses[0], found.edges[0]);
  std::size_t open_count = 2;

  Corner from = corners[1];
  VertexId from_vertex = triangles.vertex(Triangles::previous(found.edges[0]));
  double side_of_from = side_of(from);
  // The triangles at the query, each by the handle of the query.
  Handle ahead = kNone;
  Handle first = kNone;
  Handle last = Triangles::handle(triangle_count_, 0);  // of no triangle yet: nobody reads it
  for (;;) {
    if (now.conflict) {
      // The edge gives way to the two others of the triangle beyond it.
      const Handle left = triangles.mirror(Triangles::next(now.edge));
      const Handle right = triangles.mirror(Triangles::previous(now.edge));
      free[free_count++] = Triangles::first_handle(now.edge);
      open[open_count++] = look(sight, now.apex, now.to, -now.crosses[1], right);
      now = look(sight, from, now.apex, now.crosses[0], left);
      if (std::max(free_count, open_count) == stack_size) [[unlikely]] {
        grow_stacks();
        stack_size = open_.size();
        free = free_.data();
        open = open_.data();
      }
    } else {
      const Handle h = free[--free_count];
      const VertexId to_vertex = triangles.vertex(Triangles::next(now.edge));
      triangles.set_vertex(h, query_vertex);
      triangles.set_vertex(h + 1, from_vertex);
      triangles.set_vertex(h + 2, to_vertex);
      triangles.join(h, now.edge);
      triangles.join(h + 2, last + 1);
      first = first == kNone ? h : first;
      last = h;
      from = now.to;
      from_vertex = to_vertex;
      const double side_of_to = side_of(from);
      ahead = (side_of_from >= 0) & (side_of_to < 0) ? h : ahead;
      side_of_from = side_of_to;
      if (open_count == 0) break;
      now = open[--open_count];
    }
  }
  triangles.join(first + 2, last + 1);
  if (ahead == kNone) [[unlikely]] {
    // The next point lies beyond the hull. Of the infinite triangles here one has a finite one
    // across the edge at the query.
    ahead = last;
    for (const Handle h : {last + 1, last + 2}) {
      if (triangles.vertex(h) == kInfinite) ahead = triangles.mirror(h);
    }
  }
  hint_ = Triangles::triangle_of(ahead);
}

template <bool kLattice>
void Insertion<kLattice>::insert(VertexId point, VertexId next) {
  query_vertex_ = point;
  const Sight sight{points_.scaled, pair_of(points_.scaled[point]), points_.certain_determinant};
  const Found found = locate(sight);
  if (!found.certain && repeats_vertex(found)) [[unlikely]] {
    return;
  }
  dig(sight, found, next);
}

template <bool kLattice>
[[gnu::noinline, gnu::cold]] void Insertion<kLattice>::grow_stacks() {
  open_.resize(2 * open_.size());
  free_.resize(2 * free_.size());
}

template class Insertion<false>;
template class Insertion<true>;

}  // namespace spillway::kernel_2d
