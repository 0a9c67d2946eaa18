// The main function of tests that run under mpirun. All ranks run the same cases; rank 0 reports,
// the others only what failed with them. The first case that fails at any rank ends the job,
// because the ranks are no longer at the same place then.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cstdio>
#include <optional>

#include "tests/distributed/world.h"

namespace spillway::test {
namespace {

std::optional<Ranks> joined;

class Failures : public ::testing::EmptyTestEventListener {
  void OnTestPartResult(const ::testing::TestPartResult& result) override {
    if (result.failed() && world().rank() != 0) {
      fmt::print(stderr, "rank {}: {}:{}: {}\n", world().rank(),
                 result.file_name() == nullptr ? "" : result.file_name(), result.line_number(),
                 result.message());
    }
  }

  void OnTestEnd(const ::testing::TestInfo& test) override {
    if (test.result()->Failed()) {
      fmt::print(stderr, "rank {} of {}: {}.{} failed\n", world().rank(), world().size(),
                 test.test_suite_name(), test.name());
      std::fflush(stdout);
      abort_job(1);
    }
  }
};

}  // namespace

const Ranks& world() { return *joined; }

}  // namespace spillway::test

int main(int argc, char** argv) {
  using spillway::test::joined;
  ::testing::InitGoogleTest(&argc, argv);
  joined = spillway::distributed::Ranks::all();
  auto& listeners = ::testing::UnitTest::GetInstance()->listeners();
  if (joined->rank() != 0) {
    delete listeners.Release(listeners.default_result_printer());
  }
  listeners.Append(new spillway::test::Failures);
  const int result = RUN_ALL_TESTS();
  joined.reset();  // MPI is left here, not among the destructors of other libraries' globals.
  return result;
}
