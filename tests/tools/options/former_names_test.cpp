#include "tools/options/former_names.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace spillway::test {
namespace {

using ::testing::ElementsAre;

TEST(FormerNames, StandForThePresentOnesAlsoWithAValueBehind) {
  EXPECT_THAT(with_present_names({"triangulate", "--tile", "9", "--base-case=8", "--tmpdir=a=b",
                                  "--duplicates", "mean", "--distrust-headers"}),
              ElementsAre("triangulate", "--tile-points", "9", "--leaf-points=8",
                          "--scratch-folder=a=b", "--heights", "mean", "--no-trust-headers"));
}

TEST(FormerNames, LeaveOtherWordsAndWhatFollowsTwoDashes) {
  EXPECT_THAT(with_present_names({"tile", "-tile", "--tiles", "--tile-points", "--", "--tile"}),
              ElementsAre("tile", "-tile", "--tiles", "--tile-points", "--", "--tile"));
}

}  // namespace
}  // namespace spillway::test
