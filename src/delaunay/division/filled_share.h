#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "src/geometry/box.h"
#include "src/geometry/point.h"

namespace spillway::delaunay {

/// How much of the box around some points they fill: of a grid with about half as many cells as
/// there are points, the share of the cells that hold one. About 0.86 for points spread evenly,
/// much less for those of a curve or a surface; at most 1. 0 without points.
template <int D>
double filled_share(std::span<const Point<D>> points, const Box<D>& box);

/// Some of the points, spread over them, that tell how they lie: Tuning<D>::kJudgedSample.
template <int D>
std::vector<Point<D>> judged_sample(std::span<const Point<D>> points);

/// Whether points that lie in that box are those of a curve or a surface: what a sample of them, if
/// they are many, fills of the box is clearly less than what evenly spread ones do.
template <int D>
bool is_hollow(std::span<const Point<D>> points, const Box<D>& box);

}  // namespace spillway::delaunay
