#pragma once

#include <array>
#include <compare>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "src/delaunay/common/triangulation.h"
#include "src/geometry/point.h"

namespace spillway::distributed {

/// One of the things that are numbered at each rank for itself.
struct RankIndex {
  std::uint32_t rank = 0;
  std::uint32_t index = 0;
  // NOLINTNEXTLINE(modernize-use-nullptr): a false finding in what the compiler generates
  auto operator<=>(const RankIndex&) const = default;  // NOLINT(modernize-use-nullptr)
};

/// The name of the infinite vertex, above all others.
inline constexpr RankIndex kInfiniteName{~0U, ~0U};

/// What one rank holds of a Delaunay triangulation over several. Each vertex is owned by one rank,
/// and each simplex, finite or infinite, is in the share of the rank that owns its vertex of the
/// least name, and in no other.
template <int D>
struct Share {
  using Corners = std::array<VertexId, D + 1>;

  std::size_t own = 0;           ///< vertices below are this rank's, the others belong elsewhere
  std::vector<Point<D>> points;  ///< by vertex
  /// By vertex: its name, the same at all ranks: its owner and its number there.
  std::vector<RankIndex> names;
  /// By vertex: which point it is: the rank that gave it, and as which of its points. Of equal
  /// points it is the least of these.
  std::vector<RankIndex> origins;
  std::vector<Corners> simplices;  ///< numbers of vertices, or kInfiniteVertex; oriented
  int dimension = -1;  ///< of the affine hull of all ranks' points; no simplices if less than D

  /// A point that equals another one; both are origins.
  struct Duplicate {
    RankIndex dropped;
    RankIndex kept;
  };
  std::vector<Duplicate> duplicates;  ///< those whose vertex this rank owns, sorted by `dropped`
};

}  // namespace spillway::distributed
