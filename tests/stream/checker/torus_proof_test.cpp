// The proof of periodic meshes refutes what is wrong with one.

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <spillway/triangulate.h>

#include <random>
#include <string>
#include <vector>

#include "stream/checker/checker.h"
#include "tests/stream/checker/mesh_streaming.h"

namespace spillway::checker {
namespace {

using ::testing::HasSubstr;

/// A mesh of random points in the unit box as one block, whose simplices all have offsets.
template <int D>
test::StreamInMemory periodic_stream(const std::array<bool, 3>& periodic) {
  std::mt19937_64 random(1);
  std::vector<Point<3>> points(400);
  for (auto& point : points) {
    for (double& x : point) x = static_cast<double>(random() >> 40) / (1 << 24);
  }
  const PeriodicBox box{.box = {{0, 0, 0}, {1, 1, 1}}, .periodic = periodic};
  const Context context;
  MeshInMemory mesh;
  triangulate(*points_in_memory(PointView<3>(points), {}), mesh, {.dimension = D, .periodic = box},
              context);
  test::StreamInMemory stream;
  stream.stream_header.dimension = D;
  stream.stream_header.periodic = box;
  stream.with_hash = false;
  MeshStreamBlock& block = stream.blocks.emplace_back();
  for (const auto& vertex : mesh.vertices()) {
    block.finalized.push_back(static_cast<std::uint32_t>(block.vertices.size()));
    block.vertices.emplace_back(vertex);
  }
  block.corners.assign(mesh.corners().begin(), mesh.corners().end());
  for (std::size_t c = 0; c < block.corners.size(); ++c) {
    block.offsets.push_back(corner_offset(std::span(mesh.offsets()).subspan(c * D, D)));
  }
  return stream;
}

CheckReport check(test::StreamInMemory stream) { return check_mesh_stream(stream, {}); }

/// The first simplex that crosses a side, by its first corner.
template <int D>
std::size_t across(const MeshStreamBlock& block) {
  for (std::size_t c = 0; c < block.corners.size(); ++c) {
    if (block.offsets[c] != kNoOffset) return c - c % (D + 1);
  }
  return 0;
}

template <typename Dimension>
class TorusProofs : public ::testing::Test {
 protected:
  static constexpr int D = Dimension::value;
  static constexpr std::array<bool, 3> kAll{true, true, true};
};

using Dimensions = ::testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 3>>;
TYPED_TEST_SUITE(TorusProofs, Dimensions);

TYPED_TEST(TorusProofs, APeriodicMeshIsProvedWhateverHasOffsets) {
  const CheckReport report = check(periodic_stream<TestFixture::D>(this->kAll));
  EXPECT_EQ(report.fault_count, 0U) << (report.faults.empty() ? "" : report.faults[0]);
  EXPECT_THAT(report.proved, ::testing::Contains(HasSubstr("cover it exactly once")));
}

TYPED_TEST(TorusProofs, AMissingSimplexIsFound) {
  auto stream = periodic_stream<TestFixture::D>(this->kAll);
  auto& block = stream.blocks[0];
  block.corners.resize(block.corners.size() - TestFixture::D - 1);
  block.offsets.resize(block.offsets.size() - TestFixture::D - 1);
  const CheckReport report = check(std::move(stream));
  ASSERT_GT(report.fault_count, 0U);
  EXPECT_THAT(report.faults[0], HasSubstr("one side only"));
}

TYPED_TEST(TorusProofs, AWrongOffsetIsFound) {
  auto stream = periodic_stream<TestFixture::D>(this->kAll);
  auto& block = stream.blocks[0];
  block.offsets[across<TestFixture::D>(block) + 1] = CornerOffset{1U << 2U};
  EXPECT_GT(check(std::move(stream)).fault_count, 0U);
}

TYPED_TEST(TorusProofs, ASimplexThatComesTwiceIsFound) {
  auto stream = periodic_stream<TestFixture::D>(this->kAll);
  auto& block = stream.blocks[0];
  const std::size_t first = across<TestFixture::D>(block);
  for (std::size_t i = 0; i <= TestFixture::D; ++i) {
    block.corners.push_back(block.corners[first + i]);
    block.offsets.push_back(block.offsets[first + i]);
  }
  EXPECT_GT(check(std::move(stream)).fault_count, 0U);
}

TYPED_TEST(TorusProofs, AVertexThatIsMovedIsFound) {
  auto stream = periodic_stream<TestFixture::D>(this->kAll);
  auto& block = stream.blocks[0];
  const std::uint32_t vertex = block.corners[across<TestFixture::D>(block)];
  block.vertices[vertex][0] += 0.1 - (block.vertices[vertex][0] > 0.5 ? 0.2 : 0.0);
  EXPECT_GT(check(std::move(stream)).fault_count, 0U);
}

TYPED_TEST(TorusProofs, AVertexOutsideOfTheBoxIsNamed) {
  auto stream = periodic_stream<TestFixture::D>(this->kAll);
  stream.blocks[0].vertices[3][1] += 1;
  const CheckReport report = check(std::move(stream));
  ASSERT_GT(report.fault_count, 0U);
  EXPECT_THAT(report.faults[0], HasSubstr("vertex 3"));
  EXPECT_THAT(report.faults[0], HasSubstr("outside of the periodic box"));
}

TYPED_TEST(TorusProofs, AVertexWithoutExactCopiesIsNamed) {
  auto stream = periodic_stream<TestFixture::D>(this->kAll);
  stream.blocks[0].vertices[3][0] = 0x1.8p-60;
  const CheckReport report = check(std::move(stream));
  ASSERT_GT(report.fault_count, 0U);
  EXPECT_THAT(report.faults[0], HasSubstr("at which its copies are exact"));
}

TYPED_TEST(TorusProofs, ALargerBoxIsNotCovered) {
  auto stream = periodic_stream<TestFixture::D>(this->kAll);
  stream.stream_header.periodic->box.high[0] = 2;
  EXPECT_GT(check(std::move(stream)).fault_count, 0U);
}

TYPED_TEST(TorusProofs, TheSameMeshTwiceCoversTheBoxTwice) {
  auto stream = periodic_stream<TestFixture::D>(this->kAll);
  auto& block = stream.blocks[0];
  const auto vertices = static_cast<std::uint32_t>(block.vertices.size());
  const std::size_t corners = block.corners.size();
  for (std::uint32_t v = 0; v < vertices; ++v) {
    block.vertices.push_back(block.vertices[v]);
    block.finalized.push_back(vertices + v);
  }
  for (std::size_t c = 0; c < corners; ++c) {
    block.corners.push_back(vertices + block.corners[c]);
    block.offsets.push_back(block.offsets[c]);
  }
  const CheckReport report = check(std::move(stream));
  ASSERT_EQ(report.fault_count, 1U);
  EXPECT_THAT(report.faults[0], HasSubstr("cover the periodic box 2 times"));
}

TYPED_TEST(TorusProofs, AnOpenSideThatIsNotConvexIsFound) {
  for (const std::array<bool, 3> periodic :
       {std::array{true, false, true}, std::array{true, false, false}}) {
    auto stream = periodic_stream<TestFixture::D>(periodic);
    EXPECT_EQ(check(stream).fault_count, 0U);
    auto& block = stream.blocks[0];
    block.corners.resize(block.corners.size() - TestFixture::D - 1);
    block.offsets.resize(block.offsets.size() - TestFixture::D - 1);
    const CheckReport report = check(std::move(stream));
    ASSERT_GT(report.fault_count, 0U);
    EXPECT_THAT(report.faults[0], HasSubstr("does not lie on the hull"));
  }
}

}  // namespace
}  // namespace spillway::checker
