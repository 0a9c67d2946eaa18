#pragma once
// Contours of a grid of points, as the sink makes them of a stream.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <map>
#include <random>
#include <span>
#include <utility>
#include <vector>

#include "formats/disk/scratch_folder.h"
#include "stream/sinks/contour_writer.h"

namespace spillway::test {

using Line = std::vector<Point<2>>;

struct Contours {
  std::multimap<double, Line> lines;  ///< by height
  std::uint64_t spilled = 0;
  std::uint64_t shorter = 0;  ///< lines that were left out for their length
};

/// Triangles of a square grid over [0, n] x [0, n], heights given by a function; as blocks of so
/// many triangles, in an order given by a seed.
template <typename Height>
Contours contours_of_grid(int n, const Height& height, double interval, std::size_t block_size,
                          unsigned seed, ContourSinkOptions how = {.memory = 1 << 20}) {
  const auto scratch = make_scratch_folder(::testing::TempDir(), std::nullopt);
  Contours result;
  const Levels levels = how.levels = Levels::every(interval, 0);
  ContourWriter writer(
      how,
      [&](std::span<const Point<2>> points, std::int64_t level) {
        result.lines.emplace(levels.height(level), Line(points.begin(), points.end()));
      },
      *scratch);
  const auto vertex = [&](int x, int y) { return static_cast<std::uint32_t>(y * (n + 1) + x); };
  MeshStreamBlock vertices;
  for (int y = 0; y <= n; ++y) {
    for (int x = 0; x <= n; ++x) vertices.vertices.push_back({1.0 * x, 1.0 * y, height(x, y)});
  }
  const std::size_t count = vertices.vertices.size();
  writer.write(std::move(vertices));
  std::vector<std::array<std::uint32_t, 3>> triangles;
  for (int y = 0; y < n; ++y) {
    for (int x = 0; x < n; ++x) {
      triangles.push_back({vertex(x, y), vertex(x + 1, y), vertex(x + 1, y + 1)});
      triangles.push_back({vertex(x, y), vertex(x + 1, y + 1), vertex(x, y + 1)});
    }
  }
  std::shuffle(triangles.begin(), triangles.end(), std::mt19937(seed));
  std::vector<std::size_t> uses(count);
  for (const auto& triangle : triangles) {
    for (const std::uint32_t v : triangle) ++uses[v];
  }
  for (std::size_t begin = 0; begin < triangles.size(); begin += block_size) {
    MeshStreamBlock block;
    std::map<std::uint32_t, std::uint32_t> short_number;
    for (std::size_t t = begin; t < std::min(triangles.size(), begin + block_size); ++t) {
      for (const std::uint32_t v : triangles[t]) {
        const auto added =
            short_number.emplace(v, static_cast<std::uint32_t>(block.imported.size()));
        if (added.second) block.imported.push_back(v);
        block.corners.push_back(added.first->second);
        if (--uses[v] == 0) block.finalized.push_back(added.first->second);
      }
    }
    writer.write(std::move(block));
  }
  writer.finish({});
  result.spilled = writer.spilled_bytes();
  result.shorter = writer.short_lines();
  EXPECT_EQ(writer.lines(), result.lines.size());
  return result;
}

}  // namespace spillway::test
