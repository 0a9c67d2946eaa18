#include "stream/output/sequencer.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <thread>

#include "src/error.h"

namespace spillway::test {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

class KeptSlabs : public BlockSink {
 public:
  void absorb(MeshStreamBlock&) override { ++absorbed; }
  void write(MeshStreamBlock&& block) override { blocks.push_back(std::move(block)); }
  void finish(const MeshTotals&) override {}

  std::atomic<int> absorbed = 0;
  std::vector<MeshStreamBlock> blocks;
};

MeshStreamBlock block_of(std::size_t vertices, double x, std::vector<std::uint32_t> corners = {}) {
  MeshStreamBlock block;
  block.vertices.assign(vertices, LatticePoint{x, 0, 0});
  block.corners = std::move(corners);
  return block;
}

class SequencerTest : public ::testing::Test {
 protected:
  [[nodiscard]] std::vector<double> written() const {
    std::vector<double> order;
    for (const MeshStreamBlock& block : sink_.blocks) order.push_back(block.vertices.at(0)[0]);
    return order;
  }

  KeptSlabs sink_;
  MemoryBudget budget_{1 << 20};
  StageTimes times_;
};

TEST_F(SequencerTest, WritesBlocksInTheOrderOfTheirPlaces) {
  Sequencer<2> sequencer(sink_, budget_, {}, times_);
  sequencer.open_slot(1, 1);
  sequencer.open_slot(0, 2);
  sequencer.submit({1, 0}, block_of(1, 3), {}, {});
  sequencer.submit({0, 1}, block_of(1, 2), {}, {});
  EXPECT_THAT(written(), IsEmpty());
  EXPECT_EQ(sink_.absorbed, 2) << "ahead of their turn";
  sequencer.submit({0, 0}, block_of(1, 1), {}, {});
  EXPECT_THAT(written(), ElementsAre(1, 2, 3));
}

TEST_F(SequencerTest, NumbersVerticesAsTheyAreWritten) {
  Sequencer<2> sequencer(sink_, budget_, {}, times_);
  sequencer.open_slot(0, 2);
  sequencer.open_slot(1, 1);
  const StreamPlace in_first{{0, 0}, 2};
  const StreamPlace in_second{{0, 1}, 1};
  sequencer.submit({0, 1}, block_of(2, 1), {in_first}, {});
  sequencer.submit({0, 0}, block_of(3, 0), {}, {});
  sequencer.submit({1, 0}, block_of(1, 2), {in_second, in_first}, {});
  ASSERT_EQ(sink_.blocks.size(), 3U);
  EXPECT_THAT(sink_.blocks[1].imported, ElementsAre(2));
  EXPECT_THAT(sink_.blocks[2].imported, ElementsAre(4, 2));
  EXPECT_EQ(sequencer.number_of(in_second), 4U);
  EXPECT_EQ(sequencer.totals().vertices, 6U);
}

TEST_F(SequencerTest, TakesTheTableOfBlocksOfTheBudget) {
  {
    Sequencer<2> sequencer(sink_, budget_, {}, times_);
    sequencer.open_slot(0, 1000);
    sequencer.open_slot(1, 2000);
    EXPECT_GE(budget_.used(), 3000 * sizeof(std::uint64_t));
    EXPECT_LE(budget_.used(), 3000 * sizeof(std::uint64_t) + 100);
    EXPECT_THROW(sequencer.open_slot(2, 1 << 20), Failure);
  }
  EXPECT_EQ(budget_.used(), 0U);
}

TEST_F(SequencerTest, PassesOverEmptyBlocks) {
  Sequencer<2> sequencer(sink_, budget_, {}, times_);
  sequencer.open_slot(0, 2);
  sequencer.submit({0, 0}, {}, {}, {});
  EXPECT_THAT(sink_.blocks, IsEmpty());
  sequencer.submit({0, 1}, block_of(1, 1), {}, {});
  EXPECT_THAT(written(), ElementsAre(1));
}

TEST_F(SequencerTest, CountsFacetsWhereSimplicesMayBeLeftOut) {
  Sequencer<2> sequencer(sink_, budget_, {.max_edge = 1.0}, times_);
  sequencer.open_slot(0, 2);
  sequencer.submit({0, 0}, block_of(3, 0, {0, 1, 2}), {}, {});
  // Shares the edge of vertices 1 and 2.
  sequencer.submit({0, 1}, block_of(1, 1, {0, 2, 1}), {{{0, 0}, 1}, {{0, 0}, 2}}, {});
  EXPECT_EQ(sequencer.totals().simplices, 2U);
  EXPECT_EQ(sequencer.totals().hull_facets, 4U);
  EXPECT_EQ(sequencer.open_facets().count(), 4U);
}

TEST_F(SequencerTest, RoomIsWaitedForUntilBlocksAreWritten) {
  Sequencer<2> sequencer(sink_, budget_, {}, times_);
  sequencer.open_slot(0, 1);
  sequencer.open_slot(1, 1);
  sequencer.submit({1, 0}, block_of(1000, 1), {}, {});
  sequencer.wait_for_room(100'000, 2);  // there is
  sequencer.wait_for_room(0, 0);        // it is that slot's turn
  std::atomic<bool> waits = true;
  std::thread waiting([&] {
    sequencer.wait_for_room(0, 2);
    waits = false;
  });
  EXPECT_TRUE(waits);
  sequencer.submit({0, 0}, block_of(1, 0), {}, {});
  waiting.join();
  EXPECT_THAT(written(), ElementsAre(0, 1));
}

TEST_F(SequencerTest, NobodyWaitsAfterGivingUp) {
  Sequencer<2> sequencer(sink_, budget_, {}, times_);
  sequencer.open_slot(0, 1);
  sequencer.open_slot(1, 1);
  sequencer.submit({1, 0}, block_of(1000, 1), {}, {});
  std::thread waiting([&] { sequencer.wait_for_room(0, 2); });
  sequencer.give_up();
  waiting.join();
  sequencer.wait_for_room(0, 2);
}

}  // namespace
}  // namespace spillway::test
