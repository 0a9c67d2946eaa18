#pragma once
// Names and codes in VTU files that the writer and the reader share. Layout:
// docs/formats-meshes.md ("VTU").

#include <cstdint>

#include "src/rooms.h"

namespace spillway::formats::vtu {

// Field arrays.
inline constexpr const char* kDimension = "spillway_dimension";
inline constexpr const char* kLattice = "spillway_lattice";
inline constexpr const char* kCrs = "spillway_crs";
// Of a periodic mesh, a number for each axis.
inline constexpr const char* kPeriodicLow = "PeriodicLow";
inline constexpr const char* kPeriodicHigh = "PeriodicHigh";
inline constexpr const char* kPeriodicAxes = "PeriodicAxes";

// Arrays of points and cells that VTK names.
inline constexpr const char* kPoints = "Points";
inline constexpr const char* kConnectivity = "connectivity";
inline constexpr const char* kOffsets = "offsets";
inline constexpr const char* kTypes = "types";

// Point arrays.
inline constexpr const char* kInputIndex = "input_index";
inline constexpr const char* kGlobalIds = "GlobalPointIds";  // what VTK calls it

// Cell arrays.
inline constexpr const char* kPeriodicOffsets = "periodic_offsets";

// Cell types.
inline constexpr std::uint8_t kVertex = 1;
inline constexpr std::uint8_t kLine = 3;
inline constexpr std::uint8_t kTriangle = 5;
inline constexpr std::uint8_t kPolygon = 7;
inline constexpr std::uint8_t kQuadrilateral = 9;
inline constexpr std::uint8_t kTetrahedron = 10;

}  // namespace spillway::formats::vtu
