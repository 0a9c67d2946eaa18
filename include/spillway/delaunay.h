#pragma once
// Delaunay triangulations of points in memory, in two to six dimensions.

#include <spillway/cells.h>
#include <spillway/error.h>
#include <spillway/export.h>
#include <spillway/periodic.h>
#include <spillway/point_view.h>

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <stop_token>
#include <vector>

namespace spillway {

/// How the work is done. Nothing of it but `periodic` changes the result.
struct DelaunayOptions {
  /// The most threads, the caller's among them, for the triangulation and later for queries
  /// of many places at once. 0: as many as the process may use.
  unsigned threads = 0;
  /// If set, is told from time to time how many points of how many are done. Calls come from
  /// several threads, one at a time; `done` never falls. What it throws ends the run and reaches
  /// the caller.
  std::function<void(std::size_t done, std::size_t total)> progress{};
  /// A request to stop ends the run with ErrorCode::kInterrupted, soon but not at once: parts (of
  /// some hundred thousand points) and merges of them that have been begun are finished.
  std::stop_token stop{};
  /// D = 2 and D = 3: points repeat with this box (see Delaunay).
  std::optional<PeriodicBox> periodic{};
};

/// A point that equals an earlier one of the input.
template <class Index>
struct Duplicate {
  Index point;   ///< its number
  Index vertex;  ///< the number of the first point with these coordinates, which stands for it
  bool operator==(const Duplicate&) const = default;
};

/// The Delaunay triangulation of points in the plane (D = 2, cells are triangles), in space (D = 3,
/// cells are tetrahedra) or in four to six dimensions (cells are simplices of D+1 vertices). A
/// point that lies among others evenly has about 2, 7, 32, 190 or 1,300 cells; memory is needed for
/// all.
///
/// It is exact: no circumsphere of a cell has a point inside, without any tolerance. Where more
/// than D+1 points lie on one sphere, and no other rule says which way to cut, symbolic
/// perturbation decides (Devillers and Teillaud, "Perturbations for Delaunay and weighted Delaunay
/// 3D triangulations", 2011), so there is one result for every set of points: the one that CGAL
/// computes in two and three dimensions.
///
/// Vertices are the points under their numbers in the input, from 0. Of equal points the first is a
/// vertex, the others are `duplicates()`. Cells are numbered from 0, always in the same way for the
/// same input.
///
/// With DelaunayOptions::periodic it is the triangulation of the flat torus that the box is: points
/// are brought into the box, and of all copies of a cell one stands for all. There is no hull unless
/// an axis is open, and then none along the others. A cell's corners are copies of its vertices,
/// which cell_offsets() tell. Places that are asked for are brought into the box, too, and rounded
/// as points are. The copies of points near the sides that this takes are kept for such questions.
///
/// Objects can be moved, not copied. All members that are const may be called by many threads at
/// once. Spans are valid for as long as the object is, also when it has been moved to another
/// place. One that has been moved from may only be assigned to or destroyed.
template <int D, class Index = std::int32_t>
class Delaunay {
 public:
  /// Triangulates the points, of which a copy is kept. Throws Error:
  ///   kInvalidArgument  a coordinate is infinite or not a number (the text has the point's
  ///                     number), there are more than 4,096 threads, or the periodic box is not one
  ///                     of 2 or 3 dimensions, is empty, or is too small for its distance from 0
  ///   kDegenerateInput  there are no points, or all lie on one line (D = 3: one plane; in general
  ///                     one hyperplane), as fewer than D+1 do; where all axes are periodic, a cell
  ///                     is half a period long or longer
  ///   kTooLarge         more points or cells than an Index can number, or more than 4,294,967,293
  ///                     points, copies of periodic ones included
  ///   kInterrupted      options.stop asked for it
  explicit Delaunay(PointView<D> points, const DelaunayOptions& options = {});
  Delaunay(Delaunay&&) noexcept;
  Delaunay& operator=(Delaunay&&) noexcept;
  ~Delaunay();

  /// Number of points, duplicates included.
  [[nodiscard]] std::size_t point_count() const;
  /// Number of distinct points.
  [[nodiscard]] std::size_t vertex_count() const;
  /// Number of triangles, tetrahedra or simplices; at least 1.
  [[nodiscard]] std::size_t cell_count() const;

  /// The points in the order of the input, of a periodic mesh as they are in the box. Shape:
  /// point_count().
  [[nodiscard]] std::span<const Point<D>> points() const;

  /// The cells' vertices: those of cell c are the D+1 from c * (D+1) on, positively oriented: a
  /// triangle's run counter-clockwise; of a tetrahedron the first three do, seen from the last; in
  /// general the determinant of the edges from the first vertex to the others is positive.
  /// Shape: cell_count() * (D+1).
  [[nodiscard]] std::span<const Index> cell_vertices() const;

  /// Of a periodic mesh, for each of cell_vertices() the copy of the vertex that it is: so many
  /// periods along each axis beyond the vertex, -1, 0 or 1. Of the vertices of a cell, the first in
  /// the order of coordinates (x, then y, then z) has 0. A cell is positively oriented where its
  /// corners are. Shape: cell_count() * (D+1) * D; empty for other meshes.
  [[nodiscard]] std::span<const std::int8_t> cell_offsets() const;

  /// The box of a periodic mesh, its sides rounded as PeriodicBox says; those of open axes are 0.
  [[nodiscard]] std::optional<PeriodicBox> periodic() const;

  /// The cells' neighbours: the i-th one of cell c shares all its vertices with c but the i-th; -1
  /// where c's facet lies on the hull. Shape: cell_count() * (D+1).
  [[nodiscard]] std::span<const Index> cell_neighbours() const;

  /// The same as a range of Cell, each with `vertices` and `neighbours`.
  [[nodiscard]] Cells<D, Index> cells() const { return {cell_vertices(), cell_neighbours()}; }

  /// The facets of the convex hull, D vertices each, seen from outside: an edge has the mesh on its
  /// left, a triangle runs counter-clockwise; in general, with a point of the mesh that follows,
  /// the orientation has the sign of (-1)^D. Points that lie in the midst of a side of the hull are
  /// vertices of facets, too. Shape: number of facets * D.
  [[nodiscard]] std::span<const Index> hull_facets() const;

  /// The cell that has the hull facet, by number of facet; ascending. Shape: number of facets.
  [[nodiscard]] std::span<const Index> hull_cells() const;

  /// All points that equal an earlier one, ascending by `point`.
  [[nodiscard]] std::span<const Duplicate<Index>> duplicates() const;

  /// For each point the lowest number of a cell of which it is a vertex, -1 for duplicates.
  /// Shape: point_count().
  [[nodiscard]] std::span<const Index> vertex_cells() const;

  /// The centre of the cell's circumsphere, of a periodic mesh the one in the box; within 2^-40 of
  /// its radius and half a unit in the last place; infinite where it is beyond the largest double.
  /// Throws Error(kInvalidArgument) for a number that no cell has.
  [[nodiscard]] Point<D> circumcentre(Index cell) const;

  /// Those of all cells, computed by several threads. Shape: cell_count().
  [[nodiscard]] std::vector<Point<D>> circumcentres() const;

  /// A number that depends on nothing but the set of cells, each the set of its vertices'
  /// coordinates: the canonical hash, which the command prints as 16 hexadecimal digits.
  [[nodiscard]] std::uint64_t canonical_hash() const;

  /// The cell that has the place inside or on its boundary, the lowest number of several; -1
  /// outside of the hull, and for coordinates that are not finite. Exact.
  [[nodiscard]] Index locate(const Point<D>& place) const;
  /// The same for many places, by several threads. Shape: places.size().
  [[nodiscard]] std::vector<Index> locate(PointView<D> places) const;

  /// The vertex nearest to the place, also outside of the hull, the lowest number of several at the
  /// same distance; -1 for coordinates that are not finite. Exact.
  [[nodiscard]] Index nearest_vertex(const Point<D>& place) const;
  /// The same for many places, by several threads. Shape: places.size().
  [[nodiscard]] std::vector<Index> nearest_vertex(PointView<D> places) const;

  /// The value at each place of the function that is linear on every cell and has values[v] at
  /// vertex v; not a number outside of the hull, and for coordinates that are not finite. At a
  /// vertex it is that vertex's value; on a facet, those of other vertices are not looked at.
  /// Values of duplicates are not used. Computed by several threads. Shape: places.size(). Throws
  /// Error(kInvalidArgument) unless there is a value for every point.
  [[nodiscard]] std::vector<double> interpolate(std::span<const double> values,
                                                PointView<D> places) const;

 private:
  struct Mesh;
  std::unique_ptr<const Mesh> mesh_;
};

extern template class SPILLWAY_API Delaunay<2, std::int32_t>;
extern template class SPILLWAY_API Delaunay<3, std::int32_t>;
extern template class SPILLWAY_API Delaunay<4, std::int32_t>;
extern template class SPILLWAY_API Delaunay<5, std::int32_t>;
extern template class SPILLWAY_API Delaunay<6, std::int32_t>;
extern template class SPILLWAY_API Delaunay<2, std::int64_t>;
extern template class SPILLWAY_API Delaunay<3, std::int64_t>;
extern template class SPILLWAY_API Delaunay<4, std::int64_t>;
extern template class SPILLWAY_API Delaunay<5, std::int64_t>;
extern template class SPILLWAY_API Delaunay<6, std::int64_t>;

}  // namespace spillway
