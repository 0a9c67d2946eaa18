// A step that all ranks do: what one meets is what ends the job.

#include "stream/ranks/exchange/collective_step.h"

#include <gtest/gtest.h>

#include <stdexcept>

#include "tests/distributed/world.h"

namespace spillway::test {
namespace {

TEST(DoTogether, IsDoneOnceByEachRank) {
  std::uint64_t steps = 0;
  run_collective_step(world(), [&steps] { ++steps; });
  EXPECT_EQ(steps, 1U);
  world().reduce(std::span(&steps, 1), distributed::Reduction::kSum);
  EXPECT_EQ(steps, static_cast<std::uint64_t>(world().size()));
}

/// In a group of its own, as the ranks that do not throw wait for the end of the job.
TEST(DoTogether, ThrowsWhatTheFirstRankMetAsItIs) {
  const distributed::Ranks alone = world().split(world().rank());
  const auto fail = [&alone] {
    run_collective_step(alone, [] { throw std::out_of_range("no such part"); });
  };
  EXPECT_THROW(fail(), std::out_of_range);
  run_collective_step(alone, [] {});
  world().barrier();
}

TEST(DoTogether, GroupsThatSucceedAreNotHeldUpByOneThatFails) {
  const distributed::Ranks alone = world().split(world().rank());
  bool failed = false;
  try {
    run_collective_step(alone, [] {
      if (world().rank() == 0) throw std::runtime_error("only here");
    });
  } catch (const std::runtime_error&) {
    failed = true;
  }
  EXPECT_EQ(failed, world().rank() == 0);
  world().barrier();
}

}  // namespace
}  // namespace spillway::test
