#include "stream/triangulate/work_lanes.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numeric>
#include <stdexcept>
#include <vector>

namespace spillway::test {
namespace {

using ::testing::Each;
using ::testing::Le;

struct Item {
  std::uint64_t weight = 1;
  int finished = 0;
  int followed = 0;
};

/// Items that are worked off, and what was seen of it.
class WorkLanesTest : public ::testing::TestWithParam<unsigned> {
 protected:
  static constexpr std::uint64_t kRoom = 5;

  WorkLanesTest() : items_(200) {
    for (std::size_t i = 0; i < items_.size(); ++i)
      items_[i].weight = i % 4 + (i % 50 == 0 ? 9 : 0);
  }

  void begin(Item& item, const Item* next) {
    begun_.push_back(&item - items_.data());
    nexts_.push_back(next == nullptr ? -1 : next - items_.data());
    if (item.weight <= kRoom) most_ = std::max(most_.load(), under_way_ += item.weight);
  }
  void finish(Item& item) {
    // As tiles do, which wait for parts of their own work.
    std::atomic<int> sum = 0;
    parallel_for(100, 7, [&](std::size_t, std::size_t first, std::size_t last) {
      sum += static_cast<int>(last - first);
    });
    EXPECT_EQ(sum, 100);
    if (item.weight <= kRoom) under_way_ -= item.weight;
    if (&item == fails_at_) throw std::runtime_error("it fails");
    ++item.finished;
  }
  WorkLanes<Item> lanes() {
    return {GetParam(),
            kRoom,
            {.weight = [](const Item& item) { return item.weight; },
             .begin = [this](Item& item, const Item* next) { begin(item, next); },
             .finish = [this](Item& item) { finish(item); },
             .follow = [](Item& item) { item.followed += item.finished; },
             .give_up = [this] { given_up_ = true; },
             .rests = [this](const Item& next) { return rests_before_ == &next; },
             .at_rest = [this] { rest(); }}};
  }
  /// All before the item that lanes rest before are done, and no other one has been begun.
  void rest() {
    ++rests_;
    const std::ptrdiff_t done = rests_before_ - items_.data();
    EXPECT_EQ(begun_.size(), static_cast<std::size_t>(done));
    for (std::ptrdiff_t i = 0; i < done; ++i) EXPECT_EQ(items_[i].followed, 1);
    const auto all = static_cast<std::ptrdiff_t>(items_.size());
    rests_before_ = done + 50 < all ? &items_[done + 50] : nullptr;
  }
  void run(const std::function<void()>& work) { with_threads(GetParam(), work); }

  [[nodiscard]] std::vector<int> times_finished() const {
    std::vector<int> times;
    for (const Item& item : items_) times.push_back(item.finished);
    return times;
  }
  [[nodiscard]] std::vector<int> times_followed() const {
    std::vector<int> times;
    for (const Item& item : items_) times.push_back(item.followed);
    return times;
  }
  void expect_all_in_order() const {
    std::vector<std::ptrdiff_t> order(items_.size());
    std::iota(order.begin(), order.end(), 0);
    EXPECT_EQ(begun_, order);
    EXPECT_THAT(times_finished(), Each(1));
    EXPECT_THAT(times_followed(), Each(1));
    EXPECT_THAT(most_.load(), Le(kRoom));
  }

  std::vector<Item> items_;
  std::vector<std::ptrdiff_t> begun_;
  std::vector<std::ptrdiff_t> nexts_;
  std::atomic<std::uint64_t> under_way_ = 0;
  std::atomic<std::uint64_t> most_ = 0;
  Item* fails_at_ = nullptr;
  std::atomic<Item*> rests_before_ = nullptr;
  int rests_ = 0;
  std::atomic<bool> given_up_ = false;
};

TEST_P(WorkLanesTest, BeginsAllInOrderAndKeepsToItsRoom) {
  WorkLanes<Item> lanes = this->lanes();
  for (Item& item : items_) lanes.add(item);
  run([&] { lanes.work_off(); });
  expect_all_in_order();
  EXPECT_EQ(nexts_.back(), -1);
  EXPECT_EQ(nexts_.front(), 1);
}

TEST_P(WorkLanesTest, WorksBesideWhoBringsMore) {
  WorkLanes<Item> lanes = this->lanes();
  run([&] {
    TaskGroup group;
    for (Item& item : items_) {
      lanes.add(item);
      lanes.work_beside(group);
    }
    group.wait();
    lanes.work_off();
  });
  expect_all_in_order();
}

TEST_P(WorkLanesTest, RestsBeforeAnItemWithNothingUnderWayAndGoesOn) {
  rests_before_ = &items_[30];
  WorkLanes<Item> lanes = this->lanes();
  for (Item& item : items_) lanes.add(item);
  run([&] { lanes.work_off(); });
  EXPECT_EQ(rests_, 4);
  expect_all_in_order();
}

TEST_P(WorkLanesTest, ComesToRestBesideWhoBringsMore) {
  rests_before_ = &items_[80];
  WorkLanes<Item> lanes = this->lanes();
  run([&] {
    TaskGroup group;
    for (Item& item : items_) {
      lanes.add(item);
      lanes.work_beside(group);
      if (&item != &items_[120]) continue;
      lanes.come_to_rest(group);
      rest();
      rests_before_ = nullptr;
    }
    lanes.come_to_rest(group);
  });
  EXPECT_EQ(rests_, 1);
  expect_all_in_order();
}

TEST_P(WorkLanesTest, ThrowsWhatFailsAndBeginsNothingMore) {
  constexpr std::size_t kSmall = 20;  // others are under way when it fails, maybe all of them
  constexpr std::size_t kLarge = 50;  // more than the room: nothing is begun beside it
  for (const std::size_t failing : {kSmall, kLarge}) {
    for (const bool beside : {false, true}) {
      fails_at_ = &items_[failing];
      begun_.clear();
      given_up_ = false;
      WorkLanes<Item> lanes = this->lanes();
      const auto all = [&] {
        TaskGroup group;
        for (Item& item : items_) {
          lanes.add(item);
          if (beside) lanes.work_beside(group);
        }
        if (beside) group.wait();
        lanes.work_off();
      };
      EXPECT_THROW(run(all), std::runtime_error);
      EXPECT_TRUE(given_up_);
      if (failing == kLarge) {
        EXPECT_EQ(begun_.size(), kLarge + 1);
      }
      EXPECT_EQ(items_[failing].finished, 0);
      EXPECT_EQ(items_[failing].followed, 0);
      for (Item& item : items_) item.finished = item.followed = 0;
    }
  }
}

TEST_P(WorkLanesTest, BeginsOthersWhileWhatFollowsIsDone) {
  if (GetParam() < 2) GTEST_SKIP() << "for several threads";
  items_.resize(2);
  for (Item& item : items_) item.weight = kRoom;
  // As wide as a futex: those who wait for another type share a place with others.
  std::atomic<int> second_begun = 0;
  WorkLanes<Item> lanes(GetParam(), kRoom,
                        {.weight = [](const Item& item) { return item.weight; },
                         .begin =
                             [&](Item& item, const Item*) {
                               if (&item != &items_[1]) return;
                               second_begun = 1;
                               second_begun.notify_all();
                             },
                         .finish = [](Item&) {},
                         .follow =
                             [&](Item& item) {
                               if (&item == &items_[0]) second_begun.wait(0);
                             },
                         .give_up = [] {}});
  for (Item& item : items_) lanes.add(item);
  run([&] { lanes.work_off(); });
  EXPECT_EQ(second_begun, 1);
}

INSTANTIATE_TEST_SUITE_P(Threads, WorkLanesTest, ::testing::Values(1, 2, 3, 8));

}  // namespace
}  // namespace spillway::test
