// After a kill at any moment all ranks go on from the same checkpoint, or all begin again.

#include "stream/ranks/rank_checkpoints.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "tests/stream/ranks/shared_folder.h"

namespace spillway::detail::testing {
namespace {

using distributed::world;

class RankCheckpointsTest : public ::testing::Test {
 protected:
  [[nodiscard]] std::string path() const {
    return folder_ / ("rank-" + std::to_string(world().rank()));
  }
  [[nodiscard]] std::unique_ptr<CheckpointFolder> open() const {
    return std::make_unique<CheckpointFolder>(path(), RunIdentity(), std::vector<std::string>(),
                                              std::nullopt);
  }
  [[nodiscard]] static bool is_last() { return world().rank() == world().size() - 1; }

  /// A process that has made these checkpoints together, and then ends.
  void make_together(const std::vector<int>& values) const {
    const auto folder = open();
    RankCheckpoints checkpoints(*folder, 0, world());
    for (int value : values) {
      checkpoints.save_together([&](StateWriter& state) { state(value); });
    }
  }
  /// As of a rank that is killed before it accepts what it has prepared.
  static void prepare(CheckpointFolder& folder, std::uint64_t number, int value) {
    folder.prepare_checkpoint([&](StateWriter& state) { state(number, value); });
  }
  /// From what the next process goes on; 0 if it begins again.
  [[nodiscard]] int restored() const {
    const auto folder = open();
    RankCheckpoints checkpoints(*folder, 0, world());
    const auto state = checkpoints.open();
    EXPECT_EQ(checkpoints.goes_on(), state != nullptr);
    if (!state) return 0;
    int value = 0;
    (*state)(value);
    checkpoints.restored(*state);
    return value;
  }

  SharedFolder folder_;
};

TEST_F(RankCheckpointsTest, GoOnFromTheLastOneThatAllHaveMade) {
  EXPECT_EQ(restored(), 0);
  make_together({1, 2});
  EXPECT_EQ(restored(), 2);
}

TEST_F(RankCheckpointsTest, GoOnFromThoseThatRanksHaveMadeAlone) {
  {
    const auto folder = open();
    RankCheckpoints checkpoints(*folder, 0, world());
    int together = 1;
    checkpoints.save_together([&](StateWriter& state) { state(together); });
    int alone = 100 + world().rank();
    if (is_last()) checkpoints.save_alone([&](StateWriter& state) { state(alone); });
  }
  EXPECT_EQ(restored(), is_last() ? 100 + world().rank() : 1);
}

TEST_F(RankCheckpointsTest, DropWhatNotAllHavePrepared) {
  make_together({1});
  if (is_last()) prepare(*open(), 2, 2);
  EXPECT_EQ(restored(), 1);
  EXPECT_EQ(restored(), 1);
}

TEST_F(RankCheckpointsTest, AcceptWhatIsPreparedIfAnotherRankHasDoneSo) {
  make_together({1});
  {
    const auto folder = open();
    prepare(*folder, 2, 2);
    if (is_last()) folder->accept_prepared();
  }
  EXPECT_EQ(restored(), 2);
}

TEST_F(RankCheckpointsTest, BeginAgainIfARankHasLostItsFolder) {
  if (world().size() == 1) GTEST_SKIP() << "needs two ranks";
  make_together({1, 2});
  if (is_last()) std::filesystem::remove_all(path());
  {
    const auto folder = open();
    const RankCheckpoints checkpoints(*folder, 0, world());
    EXPECT_FALSE(checkpoints.goes_on());
    EXPECT_TRUE(checkpoints.lacked_some());
    EXPECT_FALSE(folder->has_checkpoint());
  }
  make_together({7});
  EXPECT_EQ(restored(), 7);
}

}  // namespace
}  // namespace spillway::detail::testing
