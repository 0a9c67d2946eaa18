#pragma once

#include <cstddef>
#include <functional>
#include <span>

#include "src/geometry/point.h"

namespace spillway::library {

/// Whether all coordinates are finite.
template <int D>
bool is_finite(const Point<D>& point);

/// Goes through many places so that one lies near the one before it: calls
/// body(places, numbers) for stretches of a Hilbert curve, by many threads at once, where
/// numbers[j] is the number of places[j]. Places with coordinates that are not finite are left out.
/// `at(i)` is place i of `count`. Runs on at most `threads` threads.
template <int D>
void for_each_near(
    std::size_t count, unsigned threads, const std::function<Point<D>(std::size_t)>& at,
    const std::function<void(std::span<const Point<D>>, std::span<const std::size_t>)>& body);

}  // namespace spillway::library
