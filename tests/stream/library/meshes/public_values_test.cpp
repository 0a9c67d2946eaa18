// Meshes of the engine as programs see them, and meshes of programs as the engine reads them.

#include "stream/library/meshes/public_values.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "formats/meshes/common/stream_numbers.h"
#include "tests/error_facts.h"
#include "tests/formats/meshes/stream_test_helpers.h"

namespace spillway::test {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

TEST(PublicHeader, SaysWhatAStreamSaysAndBackAgain) {
  MeshHeader header;
  header.dimension = 3;
  header.has_input_index = true;
  header.points = 12;
  header.extent = Extent{{-1, -2, -3}, {4, 5, 6}};
  header.crs = "EPSG:25832";
  const MeshStreamHeader stream = stream_header(header);
  EXPECT_FALSE(stream.lattice) << "coordinates of programs are output coordinates";
  const MeshHeader back = public_header(stream);
  EXPECT_EQ(back.dimension, 3);
  EXPECT_TRUE(back.has_input_index);
  EXPECT_EQ(back.points, 12U);
  EXPECT_EQ(back.extent, header.extent);
  EXPECT_EQ(back.crs, "EPSG:25832");

  const MeshHeader unknown = public_header(stream_header({}));
  EXPECT_FALSE(unknown.points);
  EXPECT_FALSE(unknown.extent);
}

TEST(PublicHeader, TellsThePeriodicBox) {
  MeshHeader header;
  header.periodic = PeriodicBox{.box = {{0, 0, 0}, {4, 4, 0}}, .periodic = {true, false, false}};
  EXPECT_EQ(public_header(stream_header(header)).periodic, header.periodic);
  header.periodic->box.high[0] = 0;
  EXPECT_THAT(error_of([&] { stream_header(header); }), HasSubstr("no length along x"));
}

TEST(ProgramBlocks, HaveTheOffsetsOfTheirCorners) {
  MeshHeader header;
  header.periodic = PeriodicBox{.box = {{0, 0, 0}, {4, 4, 0}}, .periodic = {true, false, false}};
  const MeshBlock block = {.vertices = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}},
                           .corners = {0, 1, 2, 2, 0, 1},
                           .offsets = {0, 0, 0, 0, 0, 0, 0, 0, 1, 0, -1, 0}};
  const MeshStreamBlock stream = ProgramBlocks(header).next(block);
  ASSERT_EQ(stream.offsets.size(), 3U);
  EXPECT_EQ(periods_along(stream.offsets[1], 0), 1);
  EXPECT_EQ(periods_along(stream.offsets[2], 0), -1);
  EXPECT_EQ(public_block(stream_header(header), MeshStreamBlock(stream), 0).offsets, block.offsets);

  const auto error = [&](std::size_t number, std::int8_t periods) {
    MeshBlock wrong = block;
    wrong.offsets[number] = periods;
    return error_of([&] { ProgramBlocks(header).next(wrong); });
  };
  EXPECT_THAT(error(8, 2), HasSubstr("the offset 2 along x, beyond 1"));
  EXPECT_THAT(error(9, 1), HasSubstr("the offset 1 along y, beyond 0"));
  EXPECT_THAT(error(6, 1), HasSubstr("the first corner of a simplex has an offset"));
  MeshBlock none = block;
  none.offsets.clear();
  EXPECT_THAT(error_of([&] { ProgramBlocks(header).next(none); }),
              HasSubstr("6 corners, but 0 offsets"));
}

TEST(PublicHeader, OfNoPointsHasNoExtent) {
  MeshStreamHeader stream;
  stream.extent = Box<3>{};
  EXPECT_FALSE(public_header(stream).extent);
}

/// The numbers of a block's vertices in the whole mesh, by short number.
std::vector<std::uint64_t> in_stream(const MeshStreamBlock& block, std::uint64_t first,
                                     const std::vector<std::uint32_t>& vertices) {
  const StreamNumbers numbers(first, block);
  std::vector<std::uint64_t> all;
  for (const std::uint32_t vertex : vertices) all.push_back(numbers[vertex]);
  return all;
}

class PublicBlocks : public ::testing::TestWithParam<int> {
 protected:
  StreamedMesh mesh_ = strip(GetParam(), 100, 17);
};

TEST_P(PublicBlocks, AreInOutputCoordinatesAndStreamNumbers) {
  std::uint64_t first = 0;
  for (const MeshStreamBlock& block : mesh_.blocks) {
    const MeshBlock told = public_block(mesh_.header, MeshStreamBlock(block), first);
    EXPECT_EQ(told.first_vertex, first);
    EXPECT_EQ(told.corners, in_stream(block, first, block.corners));
    EXPECT_EQ(told.finalized, in_stream(block, first, block.finalized));
    ASSERT_EQ(told.vertices.size(), block.vertices.size());
    for (std::size_t v = 0; v < told.vertices.size(); ++v) {
      EXPECT_EQ(told.vertices[v], mesh_.header.lattice->to_world(block.vertices[v]).numbers());
    }
    first += block.vertices.size();
  }
  EXPECT_EQ(first, mesh_.totals.vertices);
}

TEST_P(PublicBlocks, OfAProgramAreTheSameMeshAsAStream) {
  ProgramBlocks program(public_header(mesh_.header));
  ImportCheck imports;
  std::uint64_t first = 0;
  std::uint64_t simplices = 0;
  for (const MeshStreamBlock& block : mesh_.blocks) {
    EXPECT_EQ(program.vertices(), first);
    EXPECT_EQ(program.simplices(), simplices);
    MeshBlock told = public_block(mesh_.header, MeshStreamBlock(block), first);
    const MeshStreamBlock stream = program.next(told);
    EXPECT_EQ(in_stream(stream, first, stream.corners), told.corners);
    EXPECT_EQ(in_stream(stream, first, stream.finalized), told.finalized);
    for (const std::uint64_t vertex : stream.imported) {
      EXPECT_TRUE(imports.import(vertex)) << vertex << " is not live, or imported twice";
    }
    imports.settle(stream);
    ASSERT_EQ(stream.vertices.size(), told.vertices.size());
    for (std::size_t v = 0; v < told.vertices.size(); ++v) {
      EXPECT_EQ(in_world(mesh_.header.lattice, stream.vertices[v]).numbers(), told.vertices[v]);
    }
    first += block.vertices.size();
    simplices += told.corners.size() / static_cast<std::size_t>(GetParam() + 1);
  }
  EXPECT_EQ(program.vertices(), mesh_.totals.vertices);
  EXPECT_EQ(program.simplices(), mesh_.totals.simplices);
  EXPECT_EQ(imports.live(), 0U);
}

INSTANTIATE_TEST_SUITE_P(Dimensions, PublicBlocks, ::testing::Values(2, 3));

TEST(PublicBlock, CarriesTheInputIndexOfItsVertices) {
  MeshStreamHeader header;
  header.has_input_index = true;
  MeshStreamBlock block;
  block.vertices = {{0, 0, 0}, {1, 0, 0}};
  block.input_index = {8, 3};
  const MeshBlock told = public_block(header, std::move(block), 5);
  EXPECT_THAT(told.input_index, ElementsAre(8, 3));
  ProgramBlocks program(public_header(header));
  MeshBlock first = told;
  first.first_vertex = 0;
  EXPECT_THAT(program.next(first).input_index, ElementsAre(8, 3));
}

TEST(PublicBlock, CarriesWhatItsVerticesDo) {
  const Attribute depth{.name = "depth", .type = NumberType::kInt16, .scale = 0.1};
  const Attribute kind{.name = "kind", .type = NumberType::kUint8, .elements = 2};
  MeshHeader header{.attributes = {depth, kind}};
  MeshBlock block{.vertices = {{0, 0, 0}, {1, 0, 0}},
                  .attributes = AttributeColumns({depth, kind}, 2)};
  block.attributes.values<std::int16_t>("depth")[1] = -7;
  block.attributes.values<std::uint8_t>("kind")[2] = 9;
  for (const std::vector<Attribute>& kept : {header.attributes, {kind}}) {
    ProgramBlocks program(header);
    EXPECT_EQ(program.header().attributes.attributes(), header.attributes);
    program.keep(AttributeLayout(kept));
    EXPECT_EQ(public_header(program.header()).attributes, kept);
    MeshStreamBlock own = program.next(block);
    EXPECT_EQ(own.attributes.size(), 2 * program.header().attributes.record_size());
    const MeshBlock told = public_block(program.header(), std::move(own), 0);
    EXPECT_EQ(told.attributes.attributes(), kept);
    EXPECT_THAT(told.attributes.values<std::uint8_t>("kind"), ElementsAre(0, 0, 9, 0));
  }
}

/// A square in two blocks, of which the second is spoiled.
struct Square {
  MeshHeader header{.extent = Extent{{0, 0, 0}, {1, 1, 9}}};
  MeshBlock first{.first_vertex = 0,
                  .vertices = {{0, 0, 1}, {1, 0, 2}, {0, 1, 3}},
                  .corners = {0, 1, 2},
                  .finalized = {0}};
  MeshBlock second{
      .first_vertex = 3, .vertices = {{1, 1, 4}}, .corners = {1, 3, 2}, .finalized = {1, 2, 3}};
};

/// The error of a square that `spoil` has changed, after its first block.
std::optional<Error> error_of(const std::function<void(Square&)>& spoil) {
  Square square;
  ProgramBlocks program(square.header);
  static_cast<void>(program.next(square.first));
  spoil(square);
  return thrown_by([&] { static_cast<void>(program.next(square.second)); });
}

void expect_refused(const char* text, const std::function<void(Square&)>& spoil) {
  const auto error = error_of(spoil);
  ASSERT_TRUE(error) << text;
  EXPECT_EQ(error->code(), ErrorCode::kInvalidArgument);
  EXPECT_THAT(error->what(), HasSubstr(text));
}

TEST(ProgramBlocks, TakeASquare) {
  EXPECT_FALSE(error_of([](Square&) {}));
}

TEST(ProgramBlocks, RefuseBlocksOutOfTheirOrder) {
  expect_refused("is 0, but 3 have come before", [](Square& s) { s.second.first_vertex = 0; });
  expect_refused("is 4, but 3 have come before", [](Square& s) { s.second.first_vertex = 4; });
}

TEST(ProgramBlocks, RefuseVerticesThatHaveNotComeOrComeNoMore) {
  expect_refused("uses vertex 4, but only 4 have come", [](Square& s) { s.second.corners[0] = 4; });
  expect_refused("uses vertex 4, but only 4 have come",
                 [](Square& s) { s.second.finalized[0] = 4; });
  expect_refused("vertex 18446744073709551615", [](Square& s) {
    s.second.corners[1] = std::numeric_limits<std::uint64_t>::max();
  });
  expect_refused("uses vertex 0, which an earlier one finalized",
                 [](Square& s) { s.second.corners[2] = 0; });
  expect_refused("uses vertex 0, which an earlier one finalized",
                 [](Square& s) { s.second.finalized.push_back(0); });
  expect_refused("finalizes a vertex twice", [](Square& s) { s.second.finalized = {1, 1}; });
}

TEST(ProgramBlocks, RefuseAVertexThatTheBlockFinalizedInWhichItCame) {
  ProgramBlocks program({});
  static_cast<void>(program.next({.vertices = {{0, 0, 0}, {1, 0, 0}}, .finalized = {1}}));
  const MeshBlock later{.first_vertex = 2, .vertices = {{0, 1, 0}}, .corners = {0, 1, 2}};
  EXPECT_TRUE(thrown_by([&] { static_cast<void>(program.next(later)); }));
}

TEST(ProgramBlocks, RefuseCoordinatesThatAreNotFiniteOrOutsideOfTheExtent) {
  for (const double wrong : {std::nan(""), kInfinity, -kInfinity}) {
    for (int axis = 0; axis < 3; ++axis) {
      expect_refused("vertex 3 has a coordinate that is not finite",
                     [&](Square& s) { s.second.vertices[0][axis] = wrong; });
    }
  }
  expect_refused("vertex 3 (1, 1, 9.5) is outside",
                 [](Square& s) { s.second.vertices[0][2] = 9.5; });
}

TEST(ProgramBlocks, RefuseSimplicesOfAnotherDimension) {
  expect_refused("2 corners are not of simplices with 3 each",
                 [](Square& s) { s.second.corners.pop_back(); });
  expect_refused("4 corners are not of simplices with 3 each",
                 [](Square& s) { s.second.corners.push_back(1); });
}

TEST(ProgramBlocks, RefuseIndicesThatAreNotOneAVertex) {
  MeshHeader header;
  header.has_input_index = true;
  ProgramBlocks program(header);
  const MeshBlock without{.vertices = {{0, 0, 0}}};
  EXPECT_TRUE(thrown_by([&] { static_cast<void>(program.next(without)); }));
  const MeshBlock with{.vertices = {{0, 0, 0}}, .input_index = {7}};
  EXPECT_FALSE(thrown_by([&] { static_cast<void>(program.next(with)); }));
}

TEST(ProgramBlocks, RefuseAHeaderThatCannotBe) {
  const auto error_of_header = [](const std::function<void(MeshHeader&)>& spoil) {
    MeshHeader header{.extent = Extent{{0, 0, 0}, {1, 1, 1}}};
    spoil(header);
    return thrown_by([&] { const ProgramBlocks program(header); });
  };
  EXPECT_FALSE(error_of_header([](MeshHeader&) {}));
  EXPECT_FALSE(error_of_header([](auto& header) {
    header.extent->high = {0, 0, 0};
  })) << "a box may be a point";
  const std::vector<std::function<void(MeshHeader&)>> wrong = {
      [](auto& header) { header.dimension = 1; },
      [](auto& header) { header.dimension = 4; },
      [](auto& header) { header.extent->low[0] = -kInfinity; },
      [](auto& header) { header.extent->high[2] = kInfinity; },
      [](auto& header) { header.extent->high[1] = std::nan(""); },
      [](auto& header) { header.extent->low[1] = 2; }};
  for (std::size_t w = 0; w < wrong.size(); ++w) {
    const auto error = error_of_header(wrong[w]);
    ASSERT_TRUE(error) << "header " << w;
    EXPECT_EQ(error->code(), ErrorCode::kInvalidArgument);
  }
}

}  // namespace
}  // namespace spillway::test
