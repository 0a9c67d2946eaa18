#include "src/delaunay/kernel_2d/insertion.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "src/delaunay/kernel_2d/circles.h"
#include "src/delaunay/kernel_2d/exact_predicates.h"

namespace spillway::delaunay::kernel_2d {
namespace {

using Triangles = TriangleArray;

constexpr std::size_t kFirstListSize = 256;
constexpr Handle kNone = ~Handle{0};

[[gnu::noinline]] bool conflicts_exactly(const WorkingPoints& points, const Quad& quad) {
  return conflicts(points, quad);
}

}  // namespace

template <bool kLattice>
Insertion<kLattice>::Insertion(const WorkingPoints& points, TriangleArray triangles,
                               const std::array<VertexId, 3>& first, int lanes)
    : points_(points), triangles_(triangles), lanes_(lanes) {
  resize_lists(kFirstListSize);
  std::array<VertexId, 3> v = first;
  if (side_of_line(points_, v[0], v[1], v[2]) < 0) std::swap(v[1], v[2]);
  triangles_.set_vertices(Triangles::handle(0, 0), v[0], v[1], v[2]);
  for (std::uint32_t i = 0; i < 3; ++i) {
    // Triangle 1 + i is the infinite one beyond the edge opposite v[i].
    triangles_.set_vertices(Triangles::handle(1 + i, 0), kInfinite, v[(i + 2) % 3], v[(i + 1) % 3]);
    triangles_.join(Triangles::handle(0, i), Triangles::handle(1 + i, 0));
    triangles_.join(Triangles::handle(1 + i, 1), Triangles::handle(1 + (i + 2) % 3, 2));
  }
  for (std::uint32_t i = 0; i < triangle_count_; ++i) {
    Triangle& triangle = triangles_.record(i);
    std::fill_n(triangle.centre, 2, 0);
    triangle.inner = triangle.outer = std::numeric_limits<double>::quiet_NaN();
  }
  star_[0] = Triangles::handle(0, 0);
}

template <bool kLattice>
[[gnu::noinline]] void Insertion<kLattice>::resize_lists(std::size_t size) {
  open_.resize(size);
  boundary_.resize(size);
  star_.resize(size);
  ring_.resize(size);
}

/// The handle of a triangle's infinite vertex, or kNone.
template <bool kLattice>
Handle Insertion<kLattice>::infinite_vertex(Handle first) const {
  for (Handle h = first; h < first + 3; ++h) {
    if (triangles_.vertex(h) == kInfinite) return h;
  }
  return kNone;
}

/// Finds a triangle in conflict with the query, or kNone if it equals a vertex; that is remembered.
/// From triangle to triangle the power of the query falls, so it comes to the one that contains it.
template <bool kLattice>
[[gnu::noinline]] Handle Insertion<kLattice>::locate(const Pair& query) {
  // Of the triangles it is given, keeps the one of least power; tells if powers lead no further:
  // it is in conflict, or its tolerance hides whether it is.
  double best = std::numeric_limits<double>::infinity();
  Handle here = star_[0];
  bool found = false;
  const auto arrive = [&](Handle there) {
    const Triangle& triangle = triangles_.at_first(there);
    const double s = squared_distance(triangle, query);
    const double power = (s - triangle.inner) + (s - triangle.outer);
    if (!(power < best)) return false;
    best = power;
    here = there;
    found = s < triangle.inner;
    return !(s > triangle.outer);
  };
  bool arrived = false;
  for (std::size_t i = 0; i < star_count_ && !arrived; ++i) arrived = arrive(star_[i]);
  while (!arrived) {
    const Handle before = here;
    for (Handle h = before; h < before + 3 && !arrived; ++h) {
      arrived = arrive(Triangles::first_handle(triangles_.mirror(h)));
    }
    arrived = arrived || here == before;
  }
  return found ? here : locate_exactly(here);
}

/// The same with exact predicates: through edges that have the query on their outer side.
template <bool kLattice>
[[gnu::noinline, gnu::cold]] Handle Insertion<kLattice>::locate_exactly(Handle first) {
  const auto outside = [this](Handle h) {
    return side_of_line(points_, triangles_.next_vertex(h),
                        triangles_.vertex(Triangles::previous(h)), query_vertex_) < 0;
  };
  if (const Handle h = infinite_vertex(first); h != kNone) {
    const Handle inner = triangles_.mirror(h);
    if (outside(inner)) return first;
    first = Triangles::first_handle(inner);
  }
  for (;;) {
    Handle h = first;
    while (h < first + 3 && !outside(h)) ++h;
    if (h == first + 3) break;
    first = Triangles::first_handle(triangles_.mirror(h));
    if (infinite_vertex(first) != kNone) return first;
  }
  for (Handle h = first; h < first + 3; ++h) {
    const VertexId v = triangles_.vertex(h);
    if (points_.original(v) != points_.original(query_vertex_)) continue;
    repetitions_.push_back({query_vertex_, v});
    return kNone;
  }
  return first;
}

/// Whether the query is in conflict with the triangle beyond an edge, by the upper stages.
template <bool kLattice>
template <int kLanes>
SPILLWAY_INLINE bool Insertion<kLattice>::conflicts_beyond(Handle edge, const Pair& query) const {
  const Quad quad{triangles_.vertex(Triangles::previous(edge)), triangles_.vertex(edge),
                  triangles_.next_vertex(edge), query_vertex_};
  if constexpr (kLattice) {
    const Corner from = corner_at(points_.scaled[quad.a], query);
    const Corner apex = corner_at(points_.scaled[quad.b], query);
    const Corner to = corner_at(points_.scaled[quad.c], query);
    const double determinant = in_circle_determinant(from, to, apex);
    if (largest_square(from, to, apex) <= kExactInCircle) {
      if (determinant == 0) return tie_conflicts(from, to, apex);
      if (!std::isnan(determinant)) return determinant > 0;
    }
  }
  return conflicts_exactly(points_, quad);
}

/// Begins with the triangles of the star that are known to be in conflict: they lie side by side.
template <bool kLattice>
template <int kLanes>
SPILLWAY_INLINE auto Insertion<kLattice>::start_from_star() -> Start {
  Handle* const star = star_.data();
  Handle* const open = open_.data() + kKnownFan;
  const std::uint64_t known = known_conflicts_;
  const auto firsts = known & ~(known << 1 | known >> (star_count_ - 1));
  const auto first = static_cast<std::size_t>(std::countr_zero(firsts));
  const std::uint64_t turned = known >> first | known << (star_count_ - first);
  const auto length = std::min(static_cast<std::size_t>(std::countr_one(turned)), kKnownFan);
  std::array<Handle, kKnownFan> fan;
  for (std::size_t k = 0; k < kKnownFan; ++k) fan[k] = star[first + k];
  // All of kKnownFan, for want of a branch; what is too much comes to lie where it does no harm.
  for (std::size_t k = 0; k < kKnownFan; ++k) {
    star[2 + k] = fan[k];
    open[static_cast<std::ptrdiff_t>(1 + length - k)] = triangles_.mirror(fan[k]);
  }
  open[0] = triangles_.mirror(fan[0] + 2);
  open[1] = triangles_.mirror(fan[length - 1] + 1);
  return {2 + length, 2 + length};
}

/// Begins with a triangle that is in conflict.
template <bool kLattice>
template <int kLanes>
SPILLWAY_INLINE auto Insertion<kLattice>::start_from(Handle first) -> Start {
  Handle* const open = open_.data() + kKnownFan;
  open[0] = triangles_.mirror(first + 2);
  open[1] = triangles_.mirror(first + 1);
  open[2] = triangles_.mirror(first);
  star_[2] = first;
  return {3, 3};
}

/// Lists the triangles in conflict, to be reused, and the edges around them. Returns how many those
/// are.
template <bool kLattice>
template <int kLanes>
SPILLWAY_INLINE std::size_t Insertion<kLattice>::find_hole(const Pair& query, const Start& start) {
  const TriangleArray triangles = triangles_;
  Handle* open = open_.data() + kKnownFan;
  Handle* slots = star_.data();
  Handle* boundary = boundary_.data();
  std::size_t most = star_.size() - kAhead;
  std::size_t open_count = start.open;
  std::size_t slot_count = start.slots;
  std::size_t boundary_count = 0;
  Handle edge = open[--open_count];
  for (;;) {
    const Triangle& triangle = triangles.at(edge);
    const double s = squared_distance(triangle, query);
    bool conflict = s < triangle.inner;
    if (!conflict && !(s > triangle.outer)) [[unlikely]] {
      conflict = conflicts_beyond<kLanes>(edge, query);
    }
    if (conflict) {
      // The edge gives way to the two others of the triangle beyond it.
      slots[slot_count++] = Triangles::first_handle(edge);
      open[open_count++] = triangles.mirror(Triangles::previous(edge));
      edge = triangles.mirror(Triangles::next(edge));
      if (slot_count == most) [[unlikely]] {
        resize_lists(2 * star_.size());
        open = open_.data() + kKnownFan;
        slots = star_.data();
        boundary = boundary_.data();
        most = star_.size() - kAhead;
      }
    } else {
      boundary[boundary_count++] = edge;
      if (open_count == 0) return boundary_count;
      edge = open[--open_count];
    }
  }
}

/// Fills the hole.
template <bool kLattice>
template <int kLanes>
SPILLWAY_INLINE void Insertion<kLattice>::make_star(const Pair& query, std::size_t count,
                                                    VertexId next) {
  const TriangleArray triangles = triangles_;
  const VertexId query_vertex = query_vertex_;
  Handle* const star = star_.data();
  VertexId* const ring = ring_.data();
  const Handle* const boundary = boundary_.data();
  Handle last = star[count - 1];
  VertexId from = triangles.vertex(Triangles::previous(boundary[0]));
  ring[0] = from;
  for (std::size_t i = 0; i < count; ++i) {
    const Handle edge = boundary[i];
    const Handle h = star[i];
    const VertexId to = triangles.next_vertex(edge);
    triangles.set_vertices(h, query_vertex, from, to);
    triangles.join(h, edge);
    triangles.join(h + 2, last + 1);
    last = h;
    from = to;
    ring[i + 1] = to;
  }
  const std::array<Handle, 3> first_handles{star[0], star[1], star[2]};
  const std::array<VertexId, 3> first_vertices{ring[1], ring[2], ring[3]};
  for (std::size_t k = 0; k < 3; ++k) star[count + k] = first_handles[k];
  for (std::size_t k = 0; k < 3; ++k) ring[count + 1 + k] = first_vertices[k];
  star_count_ = count;

  const StarView view{.triangles = triangles,
                      .scaled = points_.scaled,
                      .handles = star,
                      .ring = ring,
                      .apex = query,
                      .next = pair_of(points_.scaled[next]),
                      .largest = points_.largest};
  std::uint64_t in_conflict = 0;
  std::uint32_t unproved = 0;
  for (std::size_t i = 0; i < count; i += kLanes) {
    const CircleBits bits = make_circles<kLanes>(view, i);
    in_conflict |= std::uint64_t{bits.in_conflict} << (i & 63);
    unproved |= bits.unproved;
  }
  if (unproved != 0) [[unlikely]] {
    in_conflict |= beyond_hull(count, next);
  }
  known_conflicts_ = count <= kTestedStar ? in_conflict & ((std::uint64_t{1} << count) - 1) : 0;
}

/// Bits of those infinite triangles of the star that are certainly in conflict with the next point.
template <bool kLattice>
[[gnu::noinline]] std::uint64_t Insertion<kLattice>::beyond_hull(std::size_t count,
                                                                 VertexId next) const {
  const Pair query = pair_of(points_.scaled[next]);
  std::uint64_t bits = 0;
  for (std::size_t i = 0; i < std::min(count, kTestedStar); ++i) {
    const Handle h = infinite_vertex(star_[i]);
    if (h == kNone) continue;
    const Corner a = corner_at(points_.scaled[triangles_.next_vertex(h)], query);
    const Corner b = corner_at(points_.scaled[triangles_.vertex(Triangles::previous(h))], query);
    if (cross(a, b) > cross_bound(std::max(a.square, b.square))) bits |= std::uint64_t{1} << i;
  }
  return bits;
}

template <bool kLattice>
template <int kLanes>
SPILLWAY_INLINE void Insertion<kLattice>::insert_by(VertexId point, VertexId next) {
  query_vertex_ = point;
  const Pair query = pair_of(points_.scaled[point]);
  Start start;
  if (known_conflicts_ != 0) {
    start = start_from_star<kLanes>();
  } else {
    const Handle found = locate(query);
    if (found == kNone) return;
    start = start_from<kLanes>(found);
  }
  star_[0] = Triangles::handle(triangle_count_ + 1, 0);
  star_[1] = Triangles::handle(triangle_count_, 0);
  triangle_count_ += 2;
  make_star<kLanes>(query, find_hole<kLanes>(query, start), next);
}

template <bool kLattice>
void Insertion<kLattice>::insert_by_2(VertexId point, VertexId next) {
  insert_by<2>(point, next);
}

template <bool kLattice>
void Insertion<kLattice>::insert_by_4(VertexId point, VertexId next) {
  insert_by<4>(point, next);
}

template <bool kLattice>
void Insertion<kLattice>::insert(VertexId point, VertexId next) {
  if (lanes_ >= 4) {
    insert_by_4(point, next);
  } else {
    insert_by_2(point, next);
  }
}

template class Insertion<false>;
template class Insertion<true>;

}  // namespace spillway::delaunay::kernel_2d
