#pragma once
// A mesh of few triangles that all ranks have together: one of each rank's tiles, and one that rank
// 0 has made final between them.

#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "formats/meshes/spool/mesh_spool.h"
#include "src/geometry/canonical_hash.h"
#include "stream/ranks/rank_pipeline.h"
#include "tests/distributed/world.h"

namespace spillway::test {

using Corners = std::array<Point<2>, 3>;

/// The triangle of a rank's tiles; the merged one has two corners of the last rank's, and one that
/// is new.
inline Corners triangle_of(int rank) {
  const auto x = static_cast<double>(10 * rank);
  return {Point<2>{x, 0}, {x + 3, 1}, {x, 2}};
}
inline LatticePoint raised(const Point<2>& point) { return {point[0], point[1], 7}; }
inline constexpr Point<2> kMergedCorner{5, -100};

/// The hash of one triangle.
inline std::uint64_t hash_of(const Corners& corners) {
  CanonicalHash<2> hash;
  hash.add(corners);
  return hash.value();
}

/// The block of this rank's tiles.
inline MeshStreamBlock own_block() {
  MeshStreamBlock block;
  for (const Point<2>& corner : triangle_of(world().rank())) {
    block.vertices.push_back(raised(corner));
  }
  block.corners = {0, 1, 2};
  block.finalized = {0, 1, 2};
  const bool is_last = world().rank() + 1 == world().size();
  if (is_last) block.finalized = {2};  // the others come again
  return block;
}

/// The parts of the stream, and the merged one at rank 0.
inline RankMesh small_rank_mesh() {
  const int ranks = world().size();
  const auto number = static_cast<std::uint32_t>(ranks);
  RankMesh mesh;
  for (int rank = 0; rank < ranks; ++rank) {
    mesh.sections.push_back({.rank = rank,
                             .level = 0,
                             .first_vertex = 3 * static_cast<std::uint64_t>(rank),
                             .vertices = 3,
                             .simplices = 1});
  }
  mesh.sections.push_back({.rank = 0,
                           .level = 1,
                           .first_vertex = 3 * std::uint64_t{number},
                           .vertices = 1,
                           .simplices = 1});
  mesh.own_section = static_cast<std::uint32_t>(world().rank());
  mesh.statistics.mesh.canonical_hash = hash_of(triangle_of(world().rank()));
  mesh.totals.vertices = 3 * std::uint64_t{number} + 1;
  mesh.totals.points = mesh.totals.vertices;
  mesh.totals.simplices = std::uint64_t{number} + 1;
  const Corners last = triangle_of(ranks - 1);
  const std::uint64_t merged_hash = hash_of({kMergedCorner, last[1], last[0]});
  mesh.totals.canonical_hash = merged_hash;
  for (int rank = 0; rank < ranks; ++rank) {
    mesh.totals.canonical_hash += hash_of(triangle_of(rank));
  }
  if (world().rank() != 0) return mesh;
  MergedSection& merged = mesh.merged.emplace_back();
  merged.section = number;
  merged.mesh.vertices = {raised(kMergedCorner)};
  merged.mesh.imported = {3 * (std::uint64_t{number} - 1) + 1, 3 * (std::uint64_t{number} - 1)};
  merged.mesh.corners = {0, 1, 2};
  merged.mesh.finalized = {0, 1, 2};
  merged.imported_vertices = {raised(last[1]), raised(last[0])};
  merged.canonical_hash = merged_hash;
  return mesh;
}

}  // namespace spillway::test
