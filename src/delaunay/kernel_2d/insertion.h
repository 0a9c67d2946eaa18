#pragma once
// Incremental insertion (Bowyer, Watson) of points in the plane: the triangles that a new point is
// in conflict with are found from one of them, depth first, so that the boundary of the hole comes
// in counter-clockwise order and each of its edges can be joined to the new point at once.

#include <array>
#include <cstdint>
#include <vector>

#include "src/delaunay/insertion_rounds.h"
#include "src/delaunay/kernel_2d/filters.h"
#include "src/delaunay/kernel_2d/working_points.h"

namespace spillway::kernel_2d {

/// A vertex's place in a triangle, and the edge opposite to it: 8 * triangle + slot (0, 1 or 2).
using Handle = std::uint32_t;

/// Triangles as an array of numbers, eight for each: at handle h the vertex, at h + 4 the handle of
/// the same edge in the neighbour. Vertices run counter-clockwise; the two numbers after them are
/// not used.
class TriangleArray {
 public:
  static constexpr std::size_t kTriangleBytes = 8 * sizeof(Handle);
  /// Handles have 32 bits.
  static constexpr std::size_t kMaxTriangles = std::size_t{1} << 29;

  explicit TriangleArray(void* memory) : numbers_(static_cast<std::uint32_t*>(memory)) {}

  static constexpr Handle handle(std::uint32_t triangle, std::uint32_t slot) {
    return 8 * triangle + slot;
  }
  static constexpr std::uint32_t triangle_of(Handle h) { return h >> 3; }
  /// That of the triangle's first vertex.
  static constexpr Handle first_handle(Handle h) { return h & ~Handle{7}; }
  /// The next vertex of the same triangle, counter-clockwise.
  static constexpr Handle next(Handle h) { return (h & ~Handle{3}) | (9U >> (2 * (h & 3)) & 3); }
  /// The vertex before.
  static constexpr Handle previous(Handle h) { return h + ((h & 3) == 0 ? 2 : Handle{0} - 1); }

  [[nodiscard]] VertexId vertex(Handle h) const { return numbers_[std::size_t{h}]; }
  [[nodiscard]] Handle mirror(Handle h) const { return numbers_[std::size_t{h} + 4]; }
  void set_vertex(Handle h, VertexId v) const { numbers_[std::size_t{h}] = v; }
  void set_mirror(Handle h, Handle other) const { numbers_[std::size_t{h} + 4] = other; }
  void join(Handle g, Handle h) const {
    set_mirror(g, h);
    set_mirror(h, g);
  }

 private:
  std::uint32_t* numbers_;
};

/// Builds the triangulation point by point. kLattice says what WorkingPoints::lattice does.
template <bool kLattice>
class Insertion {
 public:
  /// Starts with a triangle that is not flat. The array has room for 2 n + 2 triangles.
  Insertion(const WorkingPoints& points, TriangleArray triangles,
            const std::array<VertexId, 3>& first);

  /// Inserts a point. `next` is the one that will come next; the search for it begins in the
  /// triangle at `point` that lies in its direction.
  void insert(VertexId point, VertexId next);

  /// Triangles so far, the infinite ones included; they fill the array from its beginning.
  [[nodiscard]] std::uint32_t triangle_count() const { return triangle_count_; }
  [[nodiscard]] const std::vector<kernel::Repetition>& repetitions() const { return repetitions_; }

 private:
  /// A triangle in conflict with the query, seen from there: edge i, opposite corners[i], has the
  /// handle edges[i] in the neighbour, and crosses[i] is the cross product of its ends.
  struct Found {
    std::array<Corner, 3> corners;
    std::array<Handle, 3> edges;
    std::array<double, 3> crosses;
    std::uint32_t triangle;
    bool certain;  ///< the query lies strictly inside the circle, so it equals no vertex
  };

  /// An edge that may bound the hole, and the triangle beyond it. It begins where the boundary ends
  /// by then.
  struct Open {
    Corner to;
    Corner apex;
    Pair crosses;  ///< of the edge's beginning with the apex, and of `to` with the apex
    Handle edge;   ///< of the triangle beyond
    bool conflict;
  };

  /// What the inner loop needs of the query and its predicates, in registers.
  struct Sight {
    const Point<2>* scaled;
    Pair query;
    double certain_determinant;

    [[nodiscard]] Corner corner(VertexId v) const { return corner_at(scaled[v], query); }
  };

  Found locate(const Sight& sight) const;
  void walk(const Sight& sight, Found& found, Corner u, Corner v, double cross_uv,
            Handle edge) const;
  bool certainly_right(double cross_product, double largest, Handle a, Handle b) const;
  bool repeats_vertex(const Found& found);
  void dig(const Sight& sight, const Found& found, VertexId next);
  Open look(const Sight& sight, const Corner& from, const Corner& to, double cross_from_to,
            Handle edge) const;
  bool decide(const Open& open, const Corner& from, double determinant) const;
  void grow_stacks();

  const WorkingPoints points_;
  TriangleArray triangles_;
  std::uint32_t triangle_count_ = 4;
  std::uint32_t hint_ = 0;  ///< a finite triangle
  VertexId query_vertex_ = kInfinite;
  std::vector<Open> open_;    ///< edges to be looked at, the next one last
  std::vector<Handle> free_;  ///< first handles of triangles whose memory may be used
  std::vector<kernel::Repetition> repetitions_;
};

extern template class Insertion<false>;
extern template class Insertion<true>;

}  // namespace spillway::kernel_2d
