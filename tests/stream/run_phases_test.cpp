// The list of phases, as one process and several walk it.

#include "stream/run_phases.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "src/parallel/parallel.h"
#include "tests/stream/quiet_setup.h"
#include "tests/stream/region_stream.h"
#include "tests/stream/stream_runner.h"

namespace spillway::test {
namespace {

using ::testing::ElementsAre;
using Log = std::vector<std::string>;

/// Phases that write down what is asked of them.
class LoggedPhases final : public RunPhases<2> {
 public:
  LoggedPhases(PointStream& points, BlockSink& blocks, const RunSetup& with, Log& log)
      : RunPhases<2>(points, {}, blocks, with), log_(log) {}

  std::uint64_t counted_by_others = 0;  ///< what other processes add to each count
  RunPhase saves_at = RunPhase::kRead;  ///< a checkpoint comes before this one; kRead: none

 private:
  void read() override {
    log_.emplace_back("read");
    engine().spill(source());
  }
  void survey() override {
    log_.emplace_back("survey");
    (void)engine().take_nodes();
  }
  std::uint64_t triangulate() override {
    log_.emplace_back("triangulate");
    engine().triangulate(*engine().take_nodes(), {});
    return engine().points();
  }
  [[nodiscard]] std::uint64_t of_all(std::uint64_t count) const override {
    return count + counted_by_others;
  }
  [[nodiscard]] bool saves_before(RunPhase next) const override { return next == saves_at; }
  void save() override { log_.emplace_back("save"); }

  Log& log_;
};

/// Phases as users see them.
class LoggedProgress final : public RunProgress {
 public:
  explicit LoggedProgress(Log& log) : log_(log) {}
  void begin_phase(const char* phase) override { log_.push_back("[" + std::string(phase)); }
  void end_phase(std::uint64_t points) override { log_.push_back(std::to_string(points) + "]"); }

 private:
  Log& log_;
};

class RunPhasesTest : public ::testing::Test {
 protected:
  void walk(std::uint64_t others, RunPhase saves_at = RunPhase::kRead) {
    std::vector<std::vector<LatticePoint>> regions(1);
    for (int i = 0; i < 100; ++i) regions[0].push_back({i * 37 % 101 * 1.0, i * 53 % 103 * 1.0, 0});
    RegionStream source(regions);
    KeepingWriter mesh(2);
    QuietSetup quiet({.asked = {.input_index = true}});
    LoggedProgress progress(log_);
    LoggedPhases phases(source, mesh,
                        {quiet.options, *quiet.scratch, quiet.budget, quiet.sink, progress}, log_);
    phases.counted_by_others = others;
    phases.saves_at = saves_at;
    with_threads(phases.threads(), [&] { phases.walk(); });
  }

  Log log_;
};

TEST_F(RunPhasesTest, ComeInTheirOrderAndNothingIsDividedThatNeedNotBe) {
  walk(0);
  EXPECT_THAT(
      log_, ElementsAre("[read", "read", "100]", "[triangulate", "survey", "triangulate", "100]"));
}

TEST_F(RunPhasesTest, AllProcessesDivideIfOneOfThemHasTo) {
  walk(7);
  EXPECT_THAT(log_, ElementsAre("[read", "read", "107]", "[divide", "7]", "[triangulate", "survey",
                                "triangulate", "100]"));
}

TEST_F(RunPhasesTest, SaveBetweenPhasesWhereTheyAreToDoSo) {
  walk(0, RunPhase::kDivide);
  EXPECT_THAT(log_, ElementsAre("[read", "read", "100]", "save", "[triangulate", "survey",
                                "triangulate", "100]"));
  log_.clear();
  walk(0, RunPhase::kTriangulate);
  EXPECT_THAT(log_, ElementsAre("[read", "read", "100]", "[triangulate", "survey", "save",
                                "triangulate", "100]"));
}

}  // namespace
}  // namespace spillway::test
