#pragma once
// Incremental insertion (Bowyer, Watson) of points in the plane: the triangles that a new point is
// in conflict with are found from those already known, depth first, so that the boundary of the
// hole comes in counter-clockwise order. Then the star of the point fills the hole; its circles are
// made several at a time and tested with the next point at once.

#include <array>
#include <cstdint>
#include <vector>

#include "src/delaunay/kernel_2d/filters.h"
#include "src/delaunay/kernel_2d/triangles.h"
#include "src/delaunay/kernel_2d/working_points.h"
#include "src/delaunay/kernel_common/insertion_rounds.h"
#include "src/delaunay/kernel_common/lanes.h"

namespace spillway::delaunay::kernel_2d {

/// Builds the triangulation point by point. kLattice says what WorkingPoints::lattice does.
template <bool kLattice>
class Insertion {
 public:
  /// Starts with a triangle that is not flat. The array has room for 2 n + 2 triangles. `lanes` is
  /// what lane_width() says.
  Insertion(const WorkingPoints& points, TriangleArray triangles,
            const std::array<VertexId, 3>& first, int lanes);

  /// Inserts a point. `next` is the one that will come next.
  void insert(VertexId point, VertexId next);

  /// Triangles so far, the infinite ones included; they fill the array from its beginning.
  [[nodiscard]] std::uint32_t simplex_count() const { return triangle_count_; }
  [[nodiscard]] const TriangleArray& simplices() const { return triangles_; }
  [[nodiscard]] const std::vector<kernel::Repetition>& repetitions() const { return repetitions_; }

 private:
  /// Room after the ends of lists, for what is written ahead.
  static constexpr std::size_t kAhead = 8;
  /// Up to this many triangles of a star that the next point destroys are found without tests.
  static constexpr std::size_t kKnownFan = 4;
  /// The next point is tested with stars of at most this many triangles.
  static constexpr std::size_t kTestedStar = 60;

  /// The beginning of a search: lengths of the lists of triangles to be reused and of edges to be
  /// looked at.
  struct Start {
    std::size_t slots;
    std::size_t open;
  };

  /// The same, for each number of lanes.
  void insert_by_2(VertexId point, VertexId next);
  SPILLWAY_TARGET("avx2,bmi,bmi2") void insert_by_4(VertexId point, VertexId next);
  template <int kLanes>
  void insert_by(VertexId point, VertexId next);

  template <int kLanes>
  Start start_from_star();
  template <int kLanes>
  Start start_from(Handle first);
  Handle locate(const Pair& query);
  Handle locate_exactly(Handle first);
  template <int kLanes>
  std::size_t find_hole(const Pair& query, const Start& start);
  template <int kLanes>
  [[nodiscard]] bool conflicts_beyond(Handle edge, const Pair& query) const;
  template <int kLanes>
  void make_star(const Pair& query, std::size_t count, VertexId next);
  [[nodiscard]] std::uint64_t beyond_hull(std::size_t count, VertexId next) const;
  [[nodiscard]] Handle infinite_vertex(Handle first) const;
  void resize_lists(std::size_t size);

  const WorkingPoints points_;
  TriangleArray triangles_;
  const int lanes_;
  std::uint32_t triangle_count_ = 4;
  VertexId query_vertex_ = kInfinite;
  std::size_t star_count_ = 1;
  /// Bits of those triangles of the star that are certainly in conflict with the next point.
  std::uint64_t known_conflicts_ = 0;

  std::vector<Handle> open_;      ///< edges to be looked at, the next one last
  std::vector<Handle> boundary_;  ///< edges around the hole, in the triangles beyond
  std::vector<Handle> star_;      ///< first handles: those to be reused, then the new triangles
  std::vector<VertexId> ring_;    ///< the vertices of the hole
  std::vector<kernel::Repetition> repetitions_;
};

extern template class Insertion<false>;
extern template class Insertion<true>;

}  // namespace spillway::delaunay::kernel_2d
