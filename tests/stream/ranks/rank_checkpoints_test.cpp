// After a kill at any moment all ranks go on from the same checkpoint, or all begin again.

#include "stream/ranks/rank_checkpoints.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "formats/meshes/spool/mesh_spool.h"
#include "stream/ranks/rank_pipeline.h"
#include "tests/stream/quiet_setup.h"
#include "tests/stream/ranks/shared_inputs.h"

namespace spillway::test {
namespace {

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
  /// As of a rank that is killed before it accepts what it has prepared after its last checkpoint.
  static void prepare(CheckpointFolder& folder, int value) {
    std::string beginning;
    std::uint64_t number = 0;
    (*folder.look_at_checkpoint())(beginning, number);
    ++number;
    folder.prepare_checkpoint([&](StateWriter& state) { state(beginning, number, value); });
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
  if (is_last()) prepare(*open(), 2);
  EXPECT_EQ(restored(), 1);
  EXPECT_EQ(restored(), 1);
}

TEST_F(RankCheckpointsTest, AcceptWhatIsPreparedIfAnotherRankHasDoneSo) {
  make_together({1});
  {
    const auto folder = open();
    prepare(*folder, 2);
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

/// As on a disk of a machine that comes back after the run has begun again without it.
TEST_F(RankCheckpointsTest, BeginAgainIfARankHasACheckpointOfAnotherBeginning) {
  if (world().size() == 1) GTEST_SKIP() << "needs two ranks";
  namespace fs = std::filesystem;
  make_together({1});
  if (is_last()) fs::rename(path(), path() + ".away");
  make_together({2});
  if (is_last()) {
    fs::remove_all(path());
    fs::rename(path() + ".away", path());
  }
  EXPECT_EQ(restored(), 0);
}

/// Does something before a block, as of a process that is killed then.
class InterruptedSink final : public BlockSink {
 public:
  InterruptedSink(BlockSink& sink, int blocks, std::function<void()> interrupt)
      : sink_(sink), left_(blocks), interrupt_(std::move(interrupt)) {}
  void absorb(MeshStreamBlock& block) override { sink_.absorb(block); }
  void write(MeshStreamBlock&& block) override {
    if (left_-- == 0) interrupt_();
    sink_.write(std::move(block));
  }
  void save(StateWriter& state) override { sink_.save(state); }
  void restore(StateReader& state) override { sink_.restore(state); }
  void finish(const MeshTotals& /*totals*/) override {}

 private:
  BlockSink& sink_;
  int left_;
  std::function<void()> interrupt_;
};

/// Some ranks are to go on in the midst of their tiles, others from where they were divided.
TEST_F(RankCheckpointsTest, LeadToTheSameMeshThoughNotAllRanksHaveMadeOneAlone) {
  namespace fs = std::filesystem;
  const auto paths = write_inputs(folder_, points_of_seed(60'000, 7), 2, "npy");
  const EngineOptions options{
      .asked = {.tile_points = 300, .leaf_points = 100}, .threads = 1, .buffered_points = 2000};
  const std::string as_killed = path() + ".killed";
  std::vector<std::uint64_t> hashes;
  for (int process = 0; process < 3; ++process) {
    if (process > 0) {
      fs::remove_all(path());
      fs::rename(as_killed, path());
    }
    const auto folder = open();
    RankCheckpoints checkpoints(*folder, world().rank() == 0 ? 0 : 1e9, world());
    EXPECT_EQ(checkpoints.goes_on(), process > 0);
    const auto source = open_shared_source(disk(), paths, {.dimension = 2}, world());
    MeshStreamHeader header;
    header.dimension = 2;
    header.lattice = source->lattice();
    MeshSpool spool(header, "mesh", folder->scratch());
    InterruptedSink sink(spool, 10,
                         [&] { fs::copy(path(), as_killed, fs::copy_options::recursive); });
    QuietSetup setup(options);
    const RankMesh mesh = triangulate_over_ranks<2>(
        *source, sink, {setup.options, folder->scratch(), setup.budget, setup.sink, setup.progress},
        world(), &checkpoints);
    hashes.push_back(mesh.totals.canonical_hash);
  }
  EXPECT_EQ(hashes[1], hashes[0]);
  EXPECT_EQ(hashes[2], hashes[0]);
}

}  // namespace
}  // namespace spillway::test
