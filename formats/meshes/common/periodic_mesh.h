#pragma once
// What files say of periodic meshes, checked: their boxes and the offsets of their corners.

#include <spillway/periodic.h>

#include <array>
#include <optional>
#include <span>
#include <string>

#include "formats/meshes/common/corner_offset.h"
#include "src/geometry/lattice.h"

namespace spillway::formats {

/// The box of a mesh of so many dimensions as all formats tell it: open axes, and z in the plane,
/// have the sides 0.
PeriodicBox plain_box(PeriodicBox box, int dimension);

/// What is wrong with the box of a mesh, on the lattice if its vertices are; empty if nothing is.
std::string fault_of_box(const PeriodicBox& box, int dimension,
                         const std::optional<IntegerLattice>& lattice);

/// Whether corners of a mesh with that box may have the offset.
bool is_offset(CornerOffset offset, const PeriodicBox& box);

/// The numbers of periods that a file tells of a corner, 0 along axes that it does not tell of.
using ToldPeriods = std::array<double, 3>;

/// What is wrong with them, those of the corner of that number in its simplex; empty if nothing is.
std::string fault_of_offset(const ToldPeriods& periods, std::size_t corner, const PeriodicBox& box);

/// Of sound ones.
CornerOffset offset_of(const ToldPeriods& periods);

/// Whether a simplex with these offsets of its corners lies across a side of the box.
bool is_across(std::span<const CornerOffset> simplex);

}  // namespace spillway::formats
