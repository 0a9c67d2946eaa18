#pragma once
// Runs the pipeline on points given in memory and keeps what it writes.

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <set>
#include <string>
#include <variant>
#include <vector>

#include "formats/meshes/common/mesh_stream.h"
#include "formats/meshes/common/stream_numbers.h"
#include "formats/meshes/common/stream_vertices.h"
#include "formats/points/common/point_writer.h"
#include "formats/points/create_points.h"
#include "stream/pipeline.h"
#include "stream/source/point_source.h"

namespace spillway::detail {

/// Keeps all blocks, and checks on the way that vertices are announced before and finalized after
/// their last use, once each, and that a block imports what it uses or finalizes, and nothing else.
class KeepingWriter : public BlockSink {
 public:
  explicit KeepingWriter(int dimension) : corners_(dimension + 1) {}

  void write(MeshBlock&& block) override {
    ASSERT_EQ(block.corners.size() % corners_, 0U);
    const StreamNumbers numbers(live_.announced(), block);
    for (const std::uint64_t v : block.imported) {
      EXPECT_TRUE(live_.contains(v)) << "vertex " << v << " is imported, but not alive";
    }
    for (std::size_t v = 0; v < block.vertices.size(); ++v) live_.enter(numbers[v], {});
    live_.announce(block.vertices.size());
    std::set<std::uint32_t> used(block.finalized.begin(), block.finalized.end());
    for (const std::uint32_t c : block.corners) {
      ASSERT_LT(c, numbers.size());
      used.insert(c);
      corner_list.push_back(numbers[c]);
    }
    for (std::size_t v = block.vertices.size(); v < numbers.size(); ++v) {
      ASSERT_TRUE(used.contains(static_cast<std::uint32_t>(v)))
          << "vertex " << numbers[v] << " is imported for nothing";
    }
    for (const std::uint32_t v : block.finalized) {
      ASSERT_LT(v, numbers.size());
      EXPECT_TRUE(live_.forget(numbers[v])) << "vertex finalized twice";
    }
    vertices.insert(vertices.end(), block.vertices.begin(), block.vertices.end());
    index.insert(index.end(), block.input_index.begin(), block.input_index.end());
    most_live = std::max(most_live, live_.size());
    blocks.push_back(std::move(block));
  }
  void finish(const MeshTotals&) override {}
  [[nodiscard]] std::size_t live() const { return live_.size(); }

  std::vector<LatticePoint> vertices;
  std::vector<std::uint64_t> index;
  std::vector<std::uint64_t> corner_list;
  std::vector<MeshBlock> blocks;
  std::size_t most_live = 0;

 private:
  std::size_t corners_;
  StreamVertices<std::monostate> live_;
};

/// A file of points in the test's temporary folder, of this process alone.
template <int D>
std::string write_points(const std::vector<Point<D>>& points) {
  const std::string path = testing::TempDir() + "points" + std::to_string(::getpid()) + ".npy";
  PointWriterOptions options;
  options.coordinates = D;
  options.count = points.size();
  const auto writer = open_point_writer(disk(), path, options);
  std::vector<LatticePoint> block;
  for (const Point<D>& p : points) {
    LatticePoint point{};
    std::copy(p.begin(), p.end(), point.begin());
    block.push_back(point);
  }
  writer->write(block, {});
  writer->finish();
  return path;
}

struct StreamRun {
  RunFigures figures;
  KeepingWriter mesh;
};

template <int D>
StreamRun run_stream(const std::string& path, StreamOptions options,
                     std::uint64_t memory = std::uint64_t{1} << 30) {
  StreamRun run{{}, KeepingWriter(D)};
  options.input_index = true;
  PointSource source(disk(), {path}, {.dimension = D, .index = true});
  const auto scratch = make_scratch_folder(testing::TempDir(), std::nullopt);
  MemoryBudget budget(memory);
  run.figures = triangulate_stream<D>(source, run.mesh, *scratch, budget, options);
  return run;
}

/// All simplices as sorted input indices, sorted.
template <int D>
std::vector<std::array<VertexId, D + 1>> simplices_of(const KeepingWriter& mesh) {
  std::vector<std::array<VertexId, D + 1>> simplices(mesh.corner_list.size() / (D + 1));
  for (std::size_t i = 0; i < mesh.corner_list.size(); ++i) {
    simplices[i / (D + 1)][i % (D + 1)] = static_cast<VertexId>(mesh.index[mesh.corner_list[i]]);
  }
  for (auto& s : simplices) std::sort(s.begin(), s.end());
  std::sort(simplices.begin(), simplices.end());
  return simplices;
}

}  // namespace spillway::detail
