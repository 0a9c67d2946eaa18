#pragma once

#include <span>
#include <string>
#include <string_view>

#include "src/geometry/box.h"
#include "src/geometry/lattice.h"
#include "src/geometry/point.h"

namespace spillway::detail {

/// Whether a lattice keeps all integers of a box apart on the first `dimension` axes, and gives
/// finite numbers on the others; so for an empty box.
bool is_exact(const Lattice& lattice, const Box<3>& integers, int dimension);

/// What a source whose lattice is_exact() refutes needs.
inline constexpr std::string_view kReadLatticeRemedy =
    "the header is corrupt, or the points need a larger scale or a smaller offset";

/// Throws Error unless is_exact(): it names the source or output, the axis with its scale and
/// offset, and the remedy.
void check_lattice(const std::string& name, const Lattice& lattice, const Box<3>& integers,
                   int dimension, std::string_view remedy = kReadLatticeRemedy);

/// The largest power of two R for which is_exact() says yes of all integers up to R, their signs
/// aside; 0 if there is none.
double exact_up_to(const Lattice& lattice, int dimension);

/// Whether a coordinate of any point is larger than `most`, its sign aside.
bool any_beyond(std::span<const Point<3>> points, double most);

/// The box around points.
Box<3> box_around(std::span<const Point<3>> points);

/// Integers that are mapped into a box of output coordinates, and perhaps a few more.
Box<3> integers_of(const Lattice& lattice, const Box<3>& world);

}  // namespace spillway::detail
