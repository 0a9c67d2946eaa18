// What every sink of the library is: called by the engine, or by a program that has a mesh itself.

#include "stream/library/meshes/engine_sink.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "src/geometry/simplex_name.h"
#include "tests/error_facts.h"

namespace spillway::test {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

/// Writes down what is called.
class Recorder final : public OwnSink<spillway::MeshSink> {
 public:
  explicit Recorder(const Context& context, bool wants_extent = false)
      : OwnSink(context), wants_extent_(wants_extent) {}

  void identify(RunIdentity& identity) const override {
    identify_product("a recorder", "", identity);
  }
  [[nodiscard]] bool wants_extent() const override { return wants_extent_; }
  void extent_known(const Box<2>& extent, std::uint64_t points) override {
    calls.emplace_back("extent");
    extent_box = extent;
    extent_points = points;
  }
  void finalize(RunWatch& /*watch*/, Report& report, OtherShares& /*others*/) override {
    calls.emplace_back("complete");
    totals = report.mesh;
  }

  std::vector<std::string> calls;
  std::optional<Box<2>> extent_box;
  std::uint64_t extent_points = 0;
  MeshTotals totals;

 private:
  BlockSink& open(const MeshStart& start) override {
    calls.emplace_back(std::string("open ") + simplices_of(start.header.dimension));
    return blocks_;
  }

  struct Blocks final : BlockSink {
    explicit Blocks(std::vector<std::string>& told) : calls(told) {}
    void absorb(MeshStreamBlock& /*block*/) override { calls.emplace_back("absorb"); }
    void write(MeshStreamBlock&& /*block*/) override { calls.emplace_back("write"); }
    void finish(const MeshTotals& /*totals*/) override { calls.emplace_back("blocks end"); }
    std::vector<std::string>& calls;
  };

  bool wants_extent_;
  Blocks blocks_{calls};
};

const MeshBlock kTriangle{
    .vertices = {{0, 0, 0}, {4, 0, 0}, {0, 3, 0}}, .corners = {0, 1, 2}, .finalized = {0, 1, 2}};

TEST(OwnSink, GoesThroughTheStepsOfAnEnginesSinkForAProgram) {
  Recorder sink{Context()};
  spillway::MeshSink& door = sink;
  door.begin({});
  door.write(kTriangle);
  door.finish({.vertices = 3, .simplices = 1});
  EXPECT_THAT(sink.calls, ElementsAre("open triangles", "absorb", "write", "complete"));
  EXPECT_EQ(sink.totals, (MeshTotals{.vertices = 3, .simplices = 1}));
}

TEST(OwnSink, IsToldTheExtentOfAPlaneBeforeTheBlocksIfItWantsIt) {
  Recorder sink(Context(), true);
  spillway::MeshSink& door = sink;
  door.begin({.points = 3, .extent = Extent{{0, 0, -1}, {4, 3, 1}}});
  door.write(kTriangle);
  EXPECT_THAT(sink.calls, ElementsAre("open triangles", "extent", "absorb", "write"));
  EXPECT_EQ(sink.extent_box, (Box<2>{{0, 0}, {4, 3}}));
  EXPECT_EQ(sink.extent_points, 3U);

  Recorder without(Context(), true);
  const auto error = thrown_by([&] { static_cast<spillway::MeshSink&>(without).begin({}); });
  ASSERT_TRUE(error);
  EXPECT_EQ(error->code(), ErrorCode::kInvalidArgument);
  EXPECT_THAT(without.calls, IsEmpty());

  Recorder in_space(Context(), true);
  static_cast<spillway::MeshSink&>(in_space).begin({.dimension = 3});
  EXPECT_THAT(in_space.calls, ElementsAre("open tetrahedra"));
}

TEST(OwnSink, RefusesCallsOutOfTurn) {
  const auto code_of = [](const auto& work) {
    const auto error = thrown_by(work);
    return error ? std::optional(error->code()) : std::nullopt;
  };
  Recorder sink{Context()};
  spillway::MeshSink& door = sink;
  EXPECT_EQ(code_of([&] { door.write(kTriangle); }), ErrorCode::kInvalidArgument);
  EXPECT_EQ(code_of([&] { door.finish({}); }), ErrorCode::kInvalidArgument);
  door.begin({});
  EXPECT_EQ(code_of([&] { door.begin({}); }), ErrorCode::kInvalidArgument);
  door.write(kTriangle);
  door.finish({});
  EXPECT_EQ(code_of([&] { door.write(kTriangle); }), ErrorCode::kInvalidArgument);
  EXPECT_EQ(code_of([&] { door.finish({}); }), ErrorCode::kInvalidArgument);
  EXPECT_EQ(code_of([&] { door.begin({}); }), ErrorCode::kInvalidArgument);
  EXPECT_THAT(sink.calls, ElementsAre("open triangles", "absorb", "write", "complete"));
}

TEST(OwnSink, DoesNotGetABlockThatCannotBe) {
  Recorder sink{Context()};
  spillway::MeshSink& door = sink;
  door.begin({});
  MeshBlock block = kTriangle;
  block.corners[2] = 3;
  EXPECT_TRUE(thrown_by([&] { door.write(block); }));
  EXPECT_THAT(sink.calls, ElementsAre("open triangles"));
}

TEST(EngineSink, TakesOneMeshWhoeverCalls) {
  Recorder sink{Context()};
  sink.start({});
  EXPECT_TRUE(thrown_by([&] { static_cast<spillway::MeshSink&>(sink).begin({}); }));
  EXPECT_TRUE(thrown_by([&] { sink.start({}); }));
}

TEST(CheckMaxEdge, RefusesEdgesThatNoSimplexHas) {
  EXPECT_FALSE(thrown_by([] { check_max_edge(std::nullopt); }));
  EXPECT_FALSE(thrown_by([] { check_max_edge(1e-300); }));
  for (const double wrong : {0.0, -1.0, std::nan("")}) {
    const auto error = thrown_by([&] { check_max_edge(wrong); });
    ASSERT_TRUE(error) << wrong;
    EXPECT_EQ(error->code(), ErrorCode::kInvalidArgument);
  }
}

TEST(Terrain, IsOfTrianglesWithHeights) {
  const MeshStart plane{};
  MeshStart space{};
  space.header.dimension = 3;
  MeshStart flat{};
  flat.has_heights = false;
  EXPECT_FALSE(thrown_by([&] { refuse_tetrahedra(plane); }));
  EXPECT_FALSE(thrown_by([&] { refuse_without_heights(plane); }));
  const auto tetrahedra = thrown_by([&] { refuse_tetrahedra(space); });
  const auto heights = thrown_by([&] { refuse_without_heights(flat); });
  ASSERT_TRUE(tetrahedra && heights);
  EXPECT_EQ(tetrahedra->code(), ErrorCode::kDegenerateInput);
  EXPECT_EQ(heights->code(), ErrorCode::kDegenerateInput);
}

}  // namespace
}  // namespace spillway::test
