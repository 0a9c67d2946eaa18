#include "stream/tiles/storage/parted_points.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <vector>

namespace spillway::test {
namespace {

using ::testing::ElementsAre;

HeldPoints held_points(std::uint64_t count, bool with_carried) {
  HeldPoints held{.arrival = 70, .run = 3};
  PointBlock block;
  for (std::uint64_t i = 0; i < count; ++i) {
    const auto x = static_cast<double>(i % 10);
    const auto y = static_cast<double>(i / 10 % 10);
    block.points.push_back({x, y, static_cast<double>(i)});
    held.box.expand(block.points.back());
    if (!with_carried) continue;
    block.index.push_back(i);
    block.attributes.push_back(static_cast<std::byte>(i));
  }
  held.buffer.append(PointsView::of(block));
  return held;
}

TEST(PartedPoints, LieOnTheirSidesOfTwoCutsInTheirOrderWithWhatTheyCarry) {
  constexpr std::uint64_t kCount = 20'000;  // several pages
  const std::vector<HeldPoints> parts =
      part_points(held_points(kCount, true), {.axis = 0, .value = 4},
                  {Cut{.axis = 1, .value = 7}, Cut{.axis = 1, .value = 2}});
  ASSERT_EQ(parts.size(), 4U);
  std::uint64_t all = 0;
  for (std::size_t p = 0; p < parts.size(); ++p) {
    EXPECT_EQ(parts[p].arrival, 70U);
    EXPECT_EQ(parts[p].run, 3U);
    Box<3> box;
    double last = -1;
    parts[p].buffer.visit_all([&](const PointsView& some) {
      for (std::size_t i = 0; i < some.size(); ++i) {
        const LatticePoint& point = some.points[i];
        const bool above_first = point[0] >= 4;
        const bool above_second = point[1] >= (above_first ? 2 : 7);
        EXPECT_EQ(p, 2U * (above_first ? 1 : 0) + (above_second ? 1 : 0));
        EXPECT_GT(point[2], last) << "in the order in which they came";
        last = point[2];
        EXPECT_EQ(some.index[i], static_cast<std::uint64_t>(point[2]));
        EXPECT_EQ(some.attributes[i], static_cast<std::byte>(some.index[i]));
        box.expand(point);
      }
    });
    EXPECT_EQ(parts[p].box, box);
    all += parts[p].buffer.size();
  }
  EXPECT_EQ(all, kCount);
}

TEST(PartedPoints, AllLieBelowACutThatIsNone) {
  const std::vector<HeldPoints> parts =
      part_points(held_points(100, false), {.axis = 0, .value = 5}, {kNoCut, kNoCut});
  std::vector<std::size_t> sizes;
  for (const HeldPoints& part : parts) sizes.push_back(part.buffer.size());
  EXPECT_THAT(sizes, ElementsAre(50, 0, 50, 0));
  EXPECT_TRUE(parts[1].box.empty());
}

}  // namespace
}  // namespace spillway::test
