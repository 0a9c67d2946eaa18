#include "src/terrain/polygons_of_edges.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <vector>

#include "src/error.h"

namespace spillway::test {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

using Edges = std::vector<BoundaryEdge>;

void append(const Ring& ring, Edges& edges) {
  for (std::size_t i = 0; i < ring.size(); ++i) {
    edges.push_back({ring[i], ring[(i + 1) % ring.size()]});
  }
}

Ring square(double x, double y, double side) {
  return {{x, y}, {x + side, y}, {x + side, y + side}, {x, y + side}};
}

/// Clockwise, from its least point on.
Ring hole(double x, double y, double side) {
  return {{x, y}, {x, y + side}, {x + side, y + side}, {x + side, y}};
}

/// Of edges in any order the polygons are the same.
std::vector<PolygonWithHoles> polygons_of(const std::vector<Ring>& rings) {
  Edges edges;
  for (const Ring& ring : rings) append(ring, edges);
  const std::vector<PolygonWithHoles> polygons = polygons_of_edges(edges);
  std::shuffle(edges.begin(), edges.end(), std::mt19937(1));
  const std::vector<PolygonWithHoles> shuffled = polygons_of_edges(edges);
  EXPECT_EQ(shuffled.size(), polygons.size());
  for (std::size_t i = 0; i < polygons.size(); ++i) {
    EXPECT_EQ(shuffled[i].outer, polygons[i].outer);
    EXPECT_EQ(shuffled[i].holes, polygons[i].holes);
  }
  return polygons;
}

TEST(PolygonsOfEdges, HaveTheHolesThatAreInThem) {
  const auto polygons = polygons_of({square(0, 0, 10), hole(1, 1, 8), square(2, 2, 6),
                                     hole(3, 3, 1), hole(5, 5, 2), square(20, 0, 3)});
  ASSERT_EQ(polygons.size(), 3U);
  EXPECT_EQ(polygons[0].outer, square(0, 0, 10));
  EXPECT_THAT(polygons[0].holes, ElementsAre(hole(1, 1, 8)));
  EXPECT_EQ(polygons[1].outer, square(2, 2, 6));
  EXPECT_THAT(polygons[1].holes, ElementsAre(hole(3, 3, 1), hole(5, 5, 2)));
  EXPECT_EQ(polygons[2].outer, square(20, 0, 3));
  EXPECT_THAT(polygons[2].holes, IsEmpty());
}

TEST(PolygonsOfEdges, ThatMeetAtAPointAreSeveral) {
  const auto polygons =
      polygons_of({{{0, 0}, {1, 0}, {1, 1}, {2, 1}, {2, 2}, {1, 2}, {1, 1}, {0, 1}}});
  ASSERT_EQ(polygons.size(), 2U);
  EXPECT_EQ(polygons[0].outer, square(0, 0, 1));
  EXPECT_EQ(polygons[1].outer, square(1, 1, 1));
}

TEST(PolygonsOfEdges, ThatMeetThemselvesAtAPointHaveAHoleThere) {
  const Ring inner = {{0, 0}, {1, 2}, {2, 1}};
  const auto polygons = polygons_of({{{0, 0}, {4, 0}, {4, 4}, {0, 4}, {0, 0}, {1, 2}, {2, 1}}});
  ASSERT_EQ(polygons.size(), 1U);
  EXPECT_EQ(polygons[0].outer, square(0, 0, 4));
  EXPECT_THAT(polygons[0].holes, ElementsAre(inner));
}

TEST(PolygonsOfEdges, ThatAHoleCutsAtTwoPointsAreTwo) {
  // A hole from the left side to the right one.
  const auto polygons = polygons_of(
      {{{0, 0}, {4, 0}, {4, 2}, {4, 4}, {0, 4}, {0, 2}}, {{0, 2}, {2, 3}, {4, 2}, {2, 1}}});
  ASSERT_EQ(polygons.size(), 2U);
  EXPECT_EQ(polygons[0].outer, (Ring{{0, 0}, {4, 0}, {4, 2}, {2, 1}, {0, 2}}));
  EXPECT_EQ(polygons[1].outer, (Ring{{0, 2}, {2, 3}, {4, 2}, {4, 4}, {0, 4}}));
  EXPECT_THAT(polygons[0].holes, IsEmpty());
  EXPECT_THAT(polygons[1].holes, IsEmpty());
}

TEST(PolygonsOfEdges, HaveNoPartsOfNoWidth) {
  const auto polygons =
      polygons_of({{{0, 0}, {2, 0}, {2, 2}, {3, 3}, {4, 4}, {3, 3}, {2, 2}, {0, 2}},
                   {{7, 7}, {8, 8}},
                   {{9, 9}, {9, 9}}});
  ASSERT_EQ(polygons.size(), 1U);
  EXPECT_EQ(polygons[0].outer, square(0, 0, 2));
}

TEST(PolygonsOfEdges, ThatHaveAnEdgeInCommonBecomeOne) {
  const auto polygons = polygons_of({square(0, 0, 1), square(1, 0, 1)});
  ASSERT_EQ(polygons.size(), 1U);
  EXPECT_EQ(polygons[0].outer, (Ring{{0, 0}, {1, 0}, {2, 0}, {2, 1}, {1, 1}, {0, 1}}));
}

TEST(PolygonsOfEdges, OfEdgesThatDoNotCloseAreRefused) {
  EXPECT_THROW(polygons_of_edges({{{0, 0}, {1, 0}}, {{1, 0}, {1, 1}}}), Failure);
}

TEST(PolygonsOfEdges, OfNoneAreNone) { EXPECT_THAT(polygons_of_edges({}), IsEmpty()); }

}  // namespace
}  // namespace spillway::test
