#pragma once
// The contract over ranks: whatever their number, all of them together make the triangulation that
// one process makes.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "src/delaunay/delaunay.h"
#include "tests/stream/ranks/rank_runner.h"

namespace spillway::test {

/// The simplices of a triangulation in memory, as sorted input indices, sorted.
template <int D>
std::vector<std::array<VertexId, D + 1>> expected_simplices(const std::vector<Point<D>>& points) {
  const Triangulation<D> mesh = delaunay_triangulation<D>(points, {.threads = 1});
  std::vector<std::array<VertexId, D + 1>> simplices;
  mesh.for_each_simplex([&](SimplexId, const Simplex<D>& simplex) {
    if (simplex.infinite()) return;
    auto& indices = simplices.emplace_back();
    for (int k = 0; k <= D; ++k) indices[k] = mesh.input_index[simplex.vertices[k]];
    std::sort(indices.begin(), indices.end());
  });
  std::sort(simplices.begin(), simplices.end());
  return simplices;
}

/// All ranks together make the triangulation of these points, which are in so many files; the same
/// totals as one process. Collective; all ranks give the same points.
template <int D>
void expect_one_mesh(const std::vector<Point<D>>& points, std::size_t files,
                     const EngineOptions& options) {
  SCOPED_TRACE(::testing::Message() << points.size() << " points in " << files
                                    << " files, tiles of " << options.asked.tile_points);
  const auto expected = expected_simplices<D>(points);
  if (expected.empty()) return;  // refused, by one rank: tested by the command
  std::vector<std::string> paths;
  const distributed::Ranks& ranks = world();
  if (ranks.rank() == 0) paths = write_shared_points<D>(points, files);
  ranks.barrier();
  const RankRunResult run = run_over_ranks<D>(paths, options);
  const WholeMesh<D> mesh = gather_mesh<D>(run);
  EXPECT_EQ(run.mesh.totals.points, points.size());
  EXPECT_EQ(run.mesh.totals.vertices + run.mesh.totals.duplicates, points.size());
  EXPECT_EQ(run.mesh.totals.simplices, expected.size());
  if (ranks.rank() == 0) {
    EXPECT_TRUE(mesh.simplices == expected)
        << mesh.simplices.size() << " simplices, " << expected.size() << " expected";
    const StreamRun alone = [&] {
      const std::string path = write_points<D>(points);
      StreamRun one = run_stream<D>(path, {.threads = 1});
      std::filesystem::remove(path);
      return one;
    }();
    EXPECT_EQ(run.mesh.totals, alone.statistics.mesh);
    for (const std::string& path : paths) std::filesystem::remove(path);
  }
}

}  // namespace spillway::test
