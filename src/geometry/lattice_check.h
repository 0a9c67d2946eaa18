#pragma once

#include <span>
#include <string>

#include "src/error.h"
#include "src/geometry/box.h"
#include "src/geometry/framed_point.h"
#include "src/geometry/lattice.h"

namespace spillway::geometry {

/// Whether a lattice keeps all integers of a box apart on the first `dimension` axes, and gives
/// finite numbers on the others; so for an empty box.
bool is_exact(const IntegerLattice& lattice, const Box<3>& integers, int dimension);

/// Throws BadInput of the file whose lattice this is unless is_exact(). It names the axis with its
/// scale and offset.
void check_lattice(const FileSpot& where, const IntegerLattice& lattice, const Box<3>& integers,
                   int dimension);

/// Likewise, CannotWrite of a file that is to get the lattice.
void check_lattice_to_write(const std::string& file, const IntegerLattice& lattice,
                            const Box<3>& integers, int dimension, Remedy remedy);

/// The largest power of two R for which is_exact() says yes of all integers up to R, their signs
/// aside; 0 if there is none.
double exact_up_to(const IntegerLattice& lattice, int dimension);

/// Whether a coordinate of any point is larger than `most`, its sign aside.
bool any_beyond(std::span<const LatticePoint> points, double most);

/// The box around points, in the coordinates that they are in.
template <typename Points>
Box<3> box_around(const Points& points) {
  Box<3> box;
  for (const Point<3>& point : points) box.expand(point);
  return box;
}

/// A box of output coordinates as points at its edges have them on the lattice: what rounding has
/// done to it is undone.
Box<3> nearest_integers(const IntegerLattice& lattice, const Box<3>& world);

/// Integers that are mapped into a box of output coordinates, and perhaps a few more.
Box<3> integers_of(const IntegerLattice& lattice, const Box<3>& world);

}  // namespace spillway::geometry
