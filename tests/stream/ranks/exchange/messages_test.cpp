// What a rank takes out of a message is what another one has put into it.

#include "stream/ranks/exchange/messages.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <stdexcept>

namespace spillway::test {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;
using ::testing::SizeIs;

SourceFacts some_facts() {
  SourceFacts facts;
  facts.crs = "EPSG:25832";
  SourceFacts::Input& full = facts.inputs.emplace_back();
  full.header.name = "a.laz";
  full.header.format = "laz";
  full.header.version = "1.4";
  full.header.point_format = 6;
  full.header.coordinates = 2;
  full.header.count = 1234;
  full.header.lattice = IntegerLattice{{0.1, 0.2, 0.3}, {1, 2, 3}};
  full.header.extent.emplace();
  full.header.extent->expand(Point<3>{7, 8, 9});
  full.header.crs = "EPSG:25832";
  full.header.crs_note = "a note";
  full.header.crs_keys = {{std::byte{1}}, {std::byte{2}, std::byte{3}}, "text"};
  full.header.software = "a program";
  full.header.attributes =
      AttributeLayout({{.name = "intensity", .type = NumberType::kUint16},
                       {"height", NumberType::kInt32, 3, 0.01, 7, "metre", "above ground"}});
  full.pieces = 77;
  full.digest = FileDigest{.size = 10, .hash = 20};
  SourceFacts::Input& plain = facts.inputs.emplace_back();
  plain.header.name = "-";
  plain.opens_once = true;
  return facts;
}

TEST(Messages, HoldWhatIsKnownOfTheInputs) {
  const SourceFacts sent = some_facts();
  Packer packer;
  pack(packer, sent);
  Unpacker unpacker(packer.bytes());
  const SourceFacts facts = unpack_source_facts(unpacker);
  EXPECT_TRUE(unpacker.empty());
  EXPECT_EQ(facts.crs, sent.crs);
  ASSERT_THAT(facts.inputs, SizeIs(2));
  for (std::size_t i = 0; i < 2; ++i) {
    const SourceFacts::Input& is = facts.inputs[i];
    const SourceFacts::Input& was = sent.inputs[i];
    EXPECT_EQ(is.header.name, was.header.name);
    EXPECT_EQ(is.header.format, was.header.format);
    EXPECT_EQ(is.header.version, was.header.version);
    EXPECT_EQ(is.header.point_format, was.header.point_format);
    EXPECT_EQ(is.header.coordinates, was.header.coordinates);
    EXPECT_EQ(is.header.count, was.header.count);
    EXPECT_EQ(is.header.lattice, was.header.lattice);
    EXPECT_EQ(is.header.extent, was.header.extent);
    EXPECT_EQ(is.header.crs, was.header.crs);
    EXPECT_EQ(is.header.crs_note, was.header.crs_note);
    EXPECT_EQ(is.header.crs_keys, was.header.crs_keys);
    EXPECT_EQ(is.header.software, was.header.software);
    EXPECT_TRUE(is.header.attributes == was.header.attributes);
    EXPECT_EQ(is.pieces, was.pieces);
    EXPECT_EQ(is.opens_once, was.opens_once);
    EXPECT_EQ(is.digest, was.digest);
  }
}

TEST(Messages, ThatEndEarlyAreRefused) {
  Packer packer;
  pack(packer, some_facts());
  for (const std::size_t size : {std::size_t{0}, std::size_t{9}, packer.bytes().size() - 1}) {
    Unpacker unpacker(packer.bytes().first(size));
    EXPECT_THROW(unpack_source_facts(unpacker), std::length_error) << size;
  }
}

template <int D>
TileNode<D> tile(double lo, std::uint64_t points) {
  TileNode<D> node;
  Point<D> corner;
  corner.fill(lo);
  node.box.expand(corner);
  corner.fill(lo + 1);
  node.box.expand(corner);
  node.points = points;
  node.stored = {3, 4};
  return node;
}

template <typename Dimension>
class MessagesOfDimension : public ::testing::Test {};
using Dimensions = ::testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 3>>;
TYPED_TEST_SUITE(MessagesOfDimension, Dimensions);

TYPED_TEST(MessagesOfDimension, HoldATreeOfTilesButNotHowTheyAreStored) {
  constexpr int kD = TypeParam::value;
  TileNode<kD> root = tile<kD>(0, 60);
  TileNode<kD> inner = tile<kD>(5, 30);
  inner.children = {tile<kD>(5, 10), tile<kD>(6, 20)};
  root.children = {tile<kD>(1, 30), inner};
  Packer packer;
  pack(packer, root);
  Unpacker unpacker(packer.bytes());
  const TileNode<kD> taken = unpack_tile_node<kD>(unpacker);
  EXPECT_TRUE(unpacker.empty());
  EXPECT_EQ(taken.points, 60U);
  EXPECT_EQ(taken.box, root.box);
  EXPECT_THAT(taken.stored, IsEmpty());
  ASSERT_THAT(taken.children, SizeIs(2));
  EXPECT_TRUE(taken.children[0].leaf());
  ASSERT_THAT(taken.children[1].children, SizeIs(2));
  EXPECT_EQ(taken.children[1].children[1].points, 20U);
  EXPECT_EQ(taken.children[1].children[1].box, inner.children[1].box);
}

template <int D>
Border<D> some_border() {
  Border<D> border;
  border.dimension = D;
  for (VertexId v = 0; v < 5; ++v) {
    BorderVertex<D>& vertex = border.vertices.emplace_back();
    vertex.position.fill(0.25 * v);
    vertex.height = 100.0 + v;
    vertex.input_index = std::uint64_t{1} << (40 + v);
    if (v % 2 == 0) vertex.place = {{v, 7}, 9 + v};
  }
  for (const VertexId last : {VertexId{4}, kInfiniteVertex}) {
    std::array<VertexId, D + 1> simplex;
    for (int i = 0; i < D; ++i) simplex[i] = static_cast<VertexId>(i);
    simplex[D] = last;
    border.simplices.push_back(simplex);
  }
  return border;
}

TYPED_TEST(MessagesOfDimension, HoldABorder) {
  constexpr int kD = TypeParam::value;
  const Border<kD> sent = some_border<kD>();
  for (const bool with_index : {false, true}) {
    Packer packer;
    pack(packer, sent, with_index);
    Unpacker unpacker(packer.bytes());
    const Border<kD> taken = unpack_border<kD>(unpacker, with_index);
    EXPECT_TRUE(unpacker.empty());
    EXPECT_EQ(taken.dimension, kD);
    EXPECT_EQ(taken.simplices, sent.simplices);
    ASSERT_EQ(taken.vertices.size(), sent.vertices.size());
    for (std::size_t v = 0; v < sent.vertices.size(); ++v) {
      EXPECT_EQ(taken.vertices[v].position, sent.vertices[v].position);
      EXPECT_EQ(taken.vertices[v].height, kD == 2 ? sent.vertices[v].height : 0);
      EXPECT_EQ(taken.vertices[v].input_index, with_index ? sent.vertices[v].input_index : 0);
      EXPECT_EQ(taken.vertices[v].place.announced(), sent.vertices[v].place.announced());
      EXPECT_EQ(taken.vertices[v].place.block, sent.vertices[v].place.block);
      EXPECT_EQ(taken.vertices[v].place.vertex, sent.vertices[v].place.vertex);
    }
  }
}

TYPED_TEST(MessagesOfDimension, HoldAnEmptyBorder) {
  constexpr int kD = TypeParam::value;
  Packer packer;
  pack(packer, Border<kD>(), false);
  Unpacker unpacker(packer.bytes());
  const Border<kD> taken = unpack_border<kD>(unpacker, false);
  EXPECT_TRUE(unpacker.empty());
  EXPECT_TRUE(taken.open());
  EXPECT_THAT(taken.vertices, IsEmpty());
}

}  // namespace
}  // namespace spillway::test
