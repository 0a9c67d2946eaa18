#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "formats/points/attributes/further_coordinates.h"
#include "src/delaunay/division/cut.h"
#include "src/geometry/box.h"
#include "src/geometry/framed_point.h"
#include "stream/tiles/cuts/cut_tree.h"
#include "stream/tiles/storage/tile_segment.h"

namespace spillway::stream {

/// What is known of a tile that has become too large.
struct CrowdedTile {
  int dimension = 2;
  Box<3> box{};                             ///< around all its points
  Box<3> expected{};                        ///< around those still to come, as far as is known
  std::span<const TileSegment> segments{};  ///< those on the disk
  std::vector<LatticePoint> sample{};       ///< of those in memory
  double weight = 1;                        ///< points that each of the sample stands for
  bool complete = false;                    ///< no others come but those that are expected
  bool hollow = false;                      ///< its points lie on curves or surfaces
};

/// Whether points lie on curves or surfaces, by a sample of them: not if it is of few, nor if they
/// fill a part of their box, as the first strips of a survey do. Stricter than is_hollow(), which
/// decides less.
bool is_clearly_hollow(std::span<const LatticePoint> sample, int dimension);

/// Whether some cut of them leaves less than half of the points with simplices across it, by a
/// sample.
bool some_cut_pays(std::span<const LatticePoint> sample, int dimension);

/// About as many points as the sample of a tile has by which it is cut.
constexpr std::size_t kCutSamples = 256;

/// Where to cut it: into shares that are not too uneven, and so that few segments lie on both
/// sides; into sides that are compact, or, if it is hollow, so that few points of the sample have
/// simplices across the cut. Nothing if all its points are equal. There are points on both sides.
std::optional<Cut> choose_cut(const CrowdedTile& tile);

/// Where a large share of the sample's points are equal; nothing if that is nowhere.
std::optional<LatticePoint> heavy_place(const CrowdedTile& tile);

/// A cut of `box` between that place and others; nothing if there are no others.
std::optional<Cut> cut_beside(const Box<3>& box, const LatticePoint& place, int dimension);

/// Tiles are cut along x, y and, in space, z: the first axes of points of a dimension. What lies
/// beyond z is in the attributes of points.
constexpr int cut_axes(int dimension) { return dimension - further_axes(dimension); }

/// A box is compact if its longest side is at most so many times as long as the shortest one.
constexpr double kMostAspect = 4;

/// How many times as long as its shortest side the longest one of a box is, on its first axes.
template <int D>
double aspect(const Box<D>& box, int dimension = D) {
  double shortest = box.extent(0);
  double longest = shortest;
  for (int k = 1; k < dimension; ++k) {
    shortest = std::min(shortest, box.extent(k));
    longest = std::max(longest, box.extent(k));
  }
  if (longest == 0) return 1;
  return shortest > 0 ? longest / shortest : std::numeric_limits<double>::infinity();
}

/// Likewise, but a side counts as short only if a cut of `cell` has made it so.
double aspect_by_cuts(const Box<3>& box, const Box<3>& cell, int dimension);

/// Whether a tile of that capacity and aspect is not compact though its points are not thin
/// themselves: in compact boxes, they would be a sixteenth of the capacity each, or more.
bool too_long(double points, double aspect, std::size_t capacity);

}  // namespace spillway::stream
