// A program's sink, as the engine writes to it.

#include "stream/library/meshes/program_sink.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <stop_token>
#include <string>
#include <vector>

#include "src/error.h"
#include "tests/error_facts.h"
#include "tests/formats/meshes/stream_test_helpers.h"

namespace spillway::test {
namespace {

using ::testing::ElementsAre;

/// Keeps what it is given, block by block.
class Kept final : public spillway::MeshSink {
 public:
  void begin(const MeshHeader& header) override { headers.push_back(header); }
  void write(const MeshBlock& block) override { blocks.push_back(block); }
  void finish(const MeshTotals& totals) override { ends.push_back(totals); }

  std::vector<MeshHeader> headers;
  std::vector<MeshBlock> blocks;
  std::vector<MeshTotals> ends;
};

TEST(ProgramSink, GivesBlocksInOutputCoordinatesWhoseNumbersFollowEachOther) {
  StreamedMesh mesh = strip(3, 60, 13);
  mesh.header.crs = "EPSG:25832";
  Kept kept;
  ProgramSink sink(kept);
  BlockSink& blocks = sink.start({.header = mesh.header});
  ASSERT_EQ(kept.headers.size(), 1U);
  EXPECT_EQ(kept.headers[0].dimension, 3);
  EXPECT_EQ(kept.headers[0].crs, "EPSG:25832");
  std::vector<MeshStreamBlock> engines = mesh.blocks;
  for (MeshStreamBlock& block : engines) {
    blocks.absorb(block);
    blocks.write(std::move(block));
  }
  std::uint64_t first = 0;
  std::uint64_t simplices = 0;
  for (std::size_t b = 0; b < kept.blocks.size(); ++b) {
    const MeshBlock& block = kept.blocks[b];
    EXPECT_EQ(block.first_vertex, first);
    for (std::size_t v = 0; v < block.vertices.size(); ++v) {
      EXPECT_EQ(block.vertices[v],
                mesh.header.lattice->to_world(mesh.blocks[b].vertices[v]).numbers());
    }
    first += block.vertices.size();
    simplices += block.corners.size() / 4;
  }
  EXPECT_EQ(first, mesh.totals.vertices);
  EXPECT_EQ(simplices, mesh.totals.simplices);
}

TEST(ProgramSink, IsFinishedOnceWithTheTotalsOfTheRunAsThePhaseWrite) {
  Kept kept;
  ProgramSink sink(kept);
  BlockSink& blocks = sink.start({});
  blocks.finish({.vertices = 1});
  EXPECT_TRUE(kept.ends.empty()) << "what the engine counts is not all that the run knows";
  std::vector<std::string> phases;
  ContextOptions options;
  options.progress = [&phases](const Progress& told) {
    phases.emplace_back(std::string(told.phase) + " " + std::string(told.unit));
  };
  const Context context(options);
  RunWatch watch(context);
  Report report;
  report.mesh = {.vertices = 3, .simplices = 1};
  sink.complete(watch, report);
  EXPECT_THAT(kept.ends, ElementsAre(report.mesh));
  EXPECT_THAT(phases, ElementsAre("write triangles", "write triangles"));
}

TEST(ProgramSink, IsNotFinishedByARunThatIsStopped) {
  std::stop_source stop;
  ContextOptions options;
  options.stop = stop.get_token();
  const Context context(options);
  RunWatch watch(context);
  Kept kept;
  ProgramSink sink(kept);
  sink.start({});
  stop.request_stop();
  Report report;
  EXPECT_THROW(sink.complete(watch, report), Interrupted);
  EXPECT_TRUE(kept.ends.empty());
}

TEST(ProgramSink, TakesOneMesh) {
  Kept kept;
  ProgramSink sink(kept);
  sink.start({});
  const auto error = thrown_by([&] { sink.start({}); });
  ASSERT_TRUE(error);
  EXPECT_EQ(error->code(), ErrorCode::kInvalidArgument);
  EXPECT_EQ(kept.headers.size(), 1U);
}

}  // namespace
}  // namespace spillway::test
