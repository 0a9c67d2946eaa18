// What a rank does for the vertices that it owns while merges between ranks go on: each is
// announced once, and finalized once no rank can need it any more.

#include "stream/ranks/merges/owned_vertices.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>

namespace spillway::test {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

constexpr std::uint32_t kUsed = VertexNews::kUsed;
constexpr std::uint32_t kGained = VertexNews::kGained;
constexpr std::uint32_t kLost = VertexNews::kLost;

constexpr OutputOptions kOutput{.input_index = true, .record_size = 1};

/// Five vertices at (v, 0), of which the last was announced.
Border<2> border() {
  Border<2> border;
  border.dimension = 2;
  for (int v = 0; v < 5; ++v) {
    BorderVertex<2>& vertex = border.vertices.emplace_back();
    vertex.position = {static_cast<double>(v), 0};
    vertex.height = 10.0 * v;
    vertex.input_index = 100U + static_cast<unsigned>(v);
    border.attributes.push_back(static_cast<std::byte>(v));
  }
  border.vertices[4].place = shared_place(1, 77);
  return border;
}

/// All but the fourth are in simplices of the rank's own.
constexpr std::array<std::uint8_t, 5> kHeld{1, 1, 1, 0, 1};

TEST(SharedPlace, HoldsNumbersOf64Bits) {
  const std::uint64_t number = (std::uint64_t{3} << 33U) + 5;
  EXPECT_EQ(shared_place(9, number).block.slot, 9U);
  EXPECT_EQ(number_in_section(shared_place(9, number)), number);
}

TEST(OwnedVertices, AreAnnouncedInTheirOrderWithWhatTheyCarryWhoeverUsesThem) {
  OwnedVertices<2> owned(border(), kHeld, kOutput);
  owned.note(std::array<VertexNews, 2>{{{2, kUsed}, {4, kUsed}}});
  owned.note(std::array<VertexNews, 2>{{{0, kUsed}, {2, kUsed}}});
  const auto draft = owned.announce(7);
  ASSERT_TRUE(draft);
  EXPECT_EQ(draft->section.section, 7U);
  EXPECT_THAT(draft->section.mesh.input_index, ElementsAre(100, 102)) << "the last is known";
  EXPECT_EQ(draft->section.mesh.vertices[1], (LatticePoint{2, 0, 20}));
  EXPECT_THAT(draft->section.mesh.attributes, ElementsAre(std::byte{0}, std::byte{2}));
  EXPECT_THAT(draft->imported, IsEmpty());
  EXPECT_FALSE(owned.announce(8)) << "once";
}

TEST(OwnedVertices, TellWhoAsksWhereTheUsedOnesWereAnnounced) {
  OwnedVertices<2> owned(border(), kHeld, kOutput);
  const std::array<VertexNews, 3> news{{{4, kUsed}, {1, kLost}, {2, kUsed | kGained}}};
  owned.note(news);
  owned.announce(7);
  const Border<2> used = owned.used(news);
  ASSERT_EQ(used.vertices.size(), 2U);
  EXPECT_EQ(number_in_section(used.vertices[0].place), 77U);
  EXPECT_EQ(used.vertices[0].place.block.slot, 1U);
  EXPECT_EQ(used.vertices[1].place.block.slot, 7U);
  EXPECT_EQ(used.vertices[1].input_index, 102U);
  EXPECT_EQ(used.vertices[1].height, 20);
  EXPECT_THAT(used.attributes, ElementsAre(std::byte{4}, std::byte{2}));
  EXPECT_THAT(used.simplices, IsEmpty());
}

TEST(OwnedVertices, AreFinalizedWhenNoRankHasASimplexOfThem) {
  OwnedVertices<2> owned(border(), kHeld, kOutput);
  owned.note(std::array<VertexNews, 3>{{{0, kUsed | kLost}, {1, kUsed}, {2, kUsed | kLost}}});
  owned.note(std::array<VertexNews, 1>{{{2, kGained}}});
  owned.announce(7);
  const auto draft = owned.finalize(9);
  ASSERT_TRUE(draft) << "the first, as another rank has the third";
  EXPECT_EQ(draft->section.section, 9U);
  EXPECT_THAT(draft->section.imported_index, ElementsAre(100));
  EXPECT_THAT(draft->section.mesh.finalized, ElementsAre(0));
  ASSERT_EQ(draft->imported.size(), 1U);
  EXPECT_EQ(draft->imported[0].block.slot, 7U);
  EXPECT_THAT(draft->section.mesh.vertices, IsEmpty());

  owned.note(std::array<VertexNews, 2>{{{2, kUsed | kLost}, {1, kLost}}});
  EXPECT_FALSE(owned.announce(10));
  const auto rest = owned.finalize(12);
  ASSERT_TRUE(rest);
  EXPECT_THAT(rest->section.imported_index, ElementsAre(101, 102));
  EXPECT_THAT(rest->section.imported_attributes, ElementsAre(std::byte{1}, std::byte{2}));
  EXPECT_FALSE(owned.finalize(13)) << "once";
}

TEST(OwnedVertices, WithoutSimplicesWaitUntilAMergeUsesThem) {
  OwnedVertices<2> owned(border(), kHeld, kOutput);
  owned.note(std::array<VertexNews, 1>{{{3, kGained}}});
  EXPECT_FALSE(owned.announce(7));
  EXPECT_FALSE(owned.finalize(9));
  owned.note(std::array<VertexNews, 1>{{{3, kUsed | kLost}}});
  EXPECT_TRUE(owned.announce(10));
  EXPECT_TRUE(owned.finalize(12));
}

}  // namespace
}  // namespace spillway::test
