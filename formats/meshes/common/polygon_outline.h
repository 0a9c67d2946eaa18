#pragma once

#include <span>
#include <string_view>

#include "src/geometry/point.h"

namespace spillway::formats {

/// What keeps a polygon of three corners or more from being cut into triangles, in words that
/// follow "face 7: "; empty if it is simple: its sides touch at their common corners only. Exact;
/// takes time in proportion to the square of the number of corners.
std::string_view outline_fault(std::span<const Point<2>> outline);

/// Whether a simple polygon goes round counter-clockwise.
bool is_counterclockwise(std::span<const Point<2>> outline);

}  // namespace spillway::formats
