#pragma once
// Points and boxes for the tests of periodic meshes, and copies of cells and points.

#include <spillway/delaunay.h>

#include "tests/library/point_sets.h"

namespace spillway::test {

template <int D>
PeriodicBox square_box(double low, double side) {
  PeriodicBox box;
  for (int k = 0; k < D; ++k) {
    box.box.low[k] = low + k;
    box.box.high[k] = low + k + side;
  }
  return box;
}

/// Sets of points and boxes that are closed, with names.
template <int D>
struct PeriodicSet {
  std::string name;
  Points<D> points;
  PeriodicBox box;
};

template <int D>
std::vector<PeriodicSet<D>> periodic_sets() {
  std::vector<PeriodicSet<D>> sets;
  sets.push_back({"uniform", random_points<D>(500, 1), square_box<D>(-3, 8)});
  sets.push_back({"far from 0", random_points<D>(400, 2), square_box<D>(1000, 7.3)});
  sets.push_back({"lattice", lattice_points<D>(6, 3), square_box<D>(0, 6)});
  Points<D> clusters = random_points<D>(500, 4);
  for (std::size_t i = 0; i < clusters.size(); ++i) {
    if (i % 2 == 0) {
      for (double& c : clusters[i]) c = 1 + c * 0.01;
    }
  }
  sets.push_back({"cluster", clusters, square_box<D>(-3, 8)});
  PeriodicBox mixed = square_box<D>(-2, 4);
  mixed.periodic[0] = false;
  sets.push_back({"open along x", random_points<D>(300, 5), mixed});
  mixed = square_box<D>(-2, 4);
  mixed.periodic[D - 1] = false;
  sets.push_back({"open along the last", lattice_points<D>(4, 6), mixed});
  sets.push_back({"few, open", random_points<D>(9, 7), mixed});
  if constexpr (D == 3) {
    mixed.periodic[0] = false;
    sets.push_back({"open along x and z", random_points<D>(200, 8), mixed});
  }
  return sets;
}

/// Some points of a lattice in a box with an open axis, so that its hull has many on a plane.
template <int D>
PeriodicSet<D> flat_hull(std::uint64_t seed) {
  PeriodicSet<D> set{"flat hull", lattice_points<D>(8, seed), square_box<D>(0, 8)};
  set.points.resize(D == 2 ? 12 : 85);
  set.box.periodic[seed % D] = false;
  return set;
}

/// The coordinates of a cell's corners, the first of all copies of it: its first vertex in the box'
/// copy that the offsets say.
template <int D>
std::array<Point<D>, D + 1> placed_corners(const Delaunay<D>& mesh, std::size_t cell) {
  std::array<Point<D>, D + 1> corners;
  const PeriodicBox box = *mesh.periodic();
  for (int i = 0; i <= D; ++i) {
    const std::size_t place = cell * (D + 1) + i;
    corners[i] = mesh.points()[mesh.cell_vertices()[place]];
    for (int k = 0; k < D; ++k) {
      if (box.periodic[k]) corners[i][k] += mesh.cell_offsets()[place * D + k] * box.period(k);
    }
  }
  return corners;
}

/// Calls f(periods) for all copies of the box next to it, and for itself.
template <int D, typename F>
void for_each_copy(const PeriodicBox& box, const F& f) {
  std::array<int, D> periods;
  for (int n = 0, all = D == 2 ? 9 : 27; n < all; ++n) {
    bool along_open = false;
    for (int k = 0, rest = n; k < D; ++k, rest /= 3) {
      periods[k] = rest % 3 - 1;
      along_open |= !box.periodic[k] && periods[k] != 0;
    }
    if (!along_open) f(periods);
  }
}

template <int D>
Point<D> moved(Point<D> point, const std::array<int, D>& periods, const PeriodicBox& box) {
  for (int k = 0; k < D; ++k) {
    if (box.periodic[k]) point[k] += periods[k] * box.period(k);
  }
  return point;
}

}  // namespace spillway::test
