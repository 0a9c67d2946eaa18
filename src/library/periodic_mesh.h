#pragma once
// Triangulations of points that repeat with a box.

#include <spillway/delaunay.h>

#include <span>
#include <vector>

#include "src/geometry/torus.h"
#include "src/library/construction.h"
#include "src/library/search_starts.h"

namespace spillway::library {

/// What belongs to a periodic mesh besides the arrays of its cells: the triangulation of the points
/// in the box and copies of them around it. Places are found in it.
template <int D, class Index>
class PeriodicCopies {
 public:
  PeriodicCopies(const Torus& torus, MeshData<D, Index> mesh, std::vector<Index> point_of,
                 std::vector<Index> kept, std::vector<Index> number)
      : torus_(torus),
        mesh_(std::move(mesh)),
        point_of_(std::move(point_of)),
        kept_(std::move(kept)),
        number_(std::move(number)) {}

  [[nodiscard]] const Torus& torus() const { return torus_; }

  /// A finite place, brought into the box.
  [[nodiscard]] Point<D> in_box(Point<D> place) const {
    torus_.wrap(place);
    return place;
  }

  /// The corners of a cell where its centre lies in the box.
  [[nodiscard]] std::array<Point<D>, D + 1> corners(Index cell) const {
    return mesh_.view().corners(kept_[cell]);
  }

  /// For places in the box, which lie near each other in their order: the lowest number of a cell
  /// that has each, -1 outside of the hull.
  void locate(std::span<const Point<D>> places, std::span<Index> cells) const;
  /// The points nearest to them, the lowest number of several.
  void find_nearest(std::span<const Point<D>> places, std::span<Index> points) const;
  /// The function that is linear on every cell, and not a number outside of the hull.
  void interpolate(std::span<const double> values, std::span<const Point<D>> places,
                   std::span<double> found) const;

  /// The values at the points, for all copies, as interpolate() takes them.
  [[nodiscard]] std::vector<double> values_of_copies(std::span<const double> values) const;

  /// Makes ready for queries: not to be called by the threads of a with_threads().
  void prepare() const { starts_.of(mesh_.view(), mesh_.threads); }

 private:
  [[nodiscard]] const StartTree<D, Index>& starts() const {
    return starts_.of(mesh_.view(), mesh_.threads);
  }

  Torus torus_;
  MeshData<D, Index> mesh_;
  std::vector<Index> point_of_;  ///< by point of the mesh
  std::vector<Index> kept_;      ///< by cell: the one of the mesh whose centre lies in the box
  std::vector<Index> number_;    ///< by cell of the mesh that meets the box: which cell it is
  SearchStarts<D, Index> starts_;
};

/// A mesh whose points are in the box, and its copies.
template <int D, class Index>
struct PeriodicMesh {
  MeshData<D, Index> mesh;
  std::unique_ptr<const PeriodicCopies<D, Index>> copies;
};

/// Throws Error as the constructor of spillway::Delaunay says.
template <int D, class Index>
PeriodicMesh<D, Index> make_periodic_mesh(const PointView<D>& points, const PeriodicBox& box,
                                          const DelaunayOptions& options);

}  // namespace spillway::library
