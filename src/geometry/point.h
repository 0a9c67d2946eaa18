#pragma once

#include <array>
#include <cstdint>
#include <limits>

namespace spillway::detail {

/// The dimensions that Spillway triangulates.
template <int D>
concept SupportedDimension = (D == 2 || D == 3);

/// A point: D double coordinates. Comparison is lexicographic, which is also the order that breaks
/// ties between cocircular and cospherical points.
template <int D>
requires SupportedDimension<D>
using Point = std::array<double, D>;

/// Number of a vertex within one in-memory triangulation.
using VertexId = std::uint32_t;

/// The vertex at infinity: the apex of every infinite simplex. It is an id, never a far-away point.
inline constexpr VertexId kInfiniteVertex = std::numeric_limits<VertexId>::max();

/// No vertex at all: marks the slot of a simplex that was removed.
inline constexpr VertexId kNoVertex = kInfiniteVertex - 1;

/// The largest number of points that one in-memory triangulation holds.
inline constexpr std::size_t kMaxVertices = kNoVertex;

}  // namespace spillway::detail
