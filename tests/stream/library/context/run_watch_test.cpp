// What a program is told of its run, and how it stops it.

#include "stream/library/context/run_watch.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <stdexcept>
#include <stop_token>
#include <string>
#include <thread>
#include <vector>

#include "src/error.h"

namespace spillway::test {
namespace {

using ::testing::ElementsAre;
using ::testing::SizeIs;
using Event = Progress::Event;

/// What was told, for good.
struct Told {
  Event event = Event::kUpdated;
  std::string phase{};
  std::string unit{};
  std::uint64_t done = 0;
  std::optional<double> fraction{};
  bool nested = false;

  bool operator==(const Told&) const = default;
};

void PrintTo(const Told& told, std::ostream* out) {
  const char* const event = told.event == Event::kBegun   ? "begun"
                            : told.event == Event::kEnded ? "ended"
                                                          : "updated";
  *out << (told.nested ? "nested " : "") << told.phase << ' ' << event << ", " << told.done << ' '
       << told.unit;
  if (told.fraction) *out << ", " << *told.fraction;
}

/// A run whose events are written down.
class RunWatchTest : public ::testing::Test {
 protected:
  ContextOptions options() {
    ContextOptions options;
    options.stop = stop_.get_token();
    options.progress = [this](const Progress& told) {
      events_.push_back({told.event, std::string(told.phase), std::string(told.unit), told.done,
                         told.fraction, told.nested});
    };
    return options;
  }

  std::stop_source stop_;
  std::vector<Told> events_;
  const Context context_{options()};
  RunWatch watch_{context_};
};

TEST_F(RunWatchTest, PhasesAreToldInTheirOrderWithTheirFigures) {
  watch_.begin("read", "points");
  watch_.tell(10, 0.25);
  watch_.tell(30, std::nullopt);
  watch_.end(40);
  watch_.begin("write", "triangles");
  watch_.end(7);
  EXPECT_THAT(events_, ElementsAre(Told{Event::kBegun, "read", "points"},
                                   Told{Event::kUpdated, "read", "points", 10, 0.25},
                                   Told{Event::kUpdated, "read", "points", 30},
                                   Told{Event::kEnded, "read", "points", 40, 1.0},
                                   Told{Event::kBegun, "write", "triangles"},
                                   Told{Event::kEnded, "write", "triangles", 7, 1.0}));
}

TEST_F(RunWatchTest, AFigureThatAnotherThreadHasOvertakenIsNotTold) {
  watch_.begin("read", "points");
  watch_.tell(30, std::nullopt);
  watch_.tell(20, std::nullopt);
  watch_.tell(30, 0.5);
  watch_.end(30);
  watch_.begin("write", "triangles");
  watch_.tell(5, std::nullopt);
  std::vector<std::uint64_t> done;
  for (const Told& told : events_) {
    if (told.event == Event::kUpdated) done.push_back(told.done);
  }
  EXPECT_THAT(done, ElementsAre(30, 30, 5)) << "each phase counts from 0";
}

TEST_F(RunWatchTest, APhaseThatIsOpenHidesThoseThatBeginAndEndMeanwhile) {
  watch_.open("triangulate", "triangles");
  watch_.begin("read", "points");
  watch_.tell(5, 0.5);
  EXPECT_GE(watch_.end(9), 0);
  watch_.close(12);
  watch_.begin("write", "triangles");
  EXPECT_THAT(events_, ElementsAre(Told{Event::kBegun, "triangulate", "triangles"},
                                   Told{Event::kUpdated, "triangulate", "triangles", 5, 0.5},
                                   Told{Event::kEnded, "triangulate", "triangles", 12, 1.0},
                                   Told{Event::kBegun, "write", "triangles"}));
}

TEST_F(RunWatchTest, APhaseWithinAnotherLeavesThatAsItIs) {
  watch_.begin("triangulate", "triangles");
  watch_.tell(100, 0.1);
  watch_.begin_nested("divide", "points");
  watch_.tell_nested(3, 0.5);
  watch_.tell(200, 0.2);
  watch_.end_nested(6);
  watch_.end(300);
  EXPECT_THAT(events_, ElementsAre(Told{Event::kBegun, "triangulate", "triangles"},
                                   Told{Event::kUpdated, "triangulate", "triangles", 100, 0.1},
                                   Told{Event::kBegun, "divide", "points", 0, std::nullopt, true},
                                   Told{Event::kUpdated, "divide", "points", 3, 0.5, true},
                                   Told{Event::kUpdated, "triangulate", "triangles", 200, 0.2},
                                   Told{Event::kEnded, "divide", "points", 6, 1.0, true},
                                   Told{Event::kEnded, "triangulate", "triangles", 300, 1.0}));
}

TEST_F(RunWatchTest, APhaseTakesTheSecondsFromItsBeginningOn) {
  watch_.begin("wait", "points");
  std::this_thread::sleep_for(std::chrono::milliseconds(20));
  const double waited = watch_.end(0);
  EXPECT_GE(waited, 0.02);
  watch_.begin("nothing", "points");
  EXPECT_LT(watch_.end(0), waited) << "the phase before is not counted";
}

TEST_F(RunWatchTest, ARequestToStopEndsTheRunWhereverItIsTold) {
  watch_.begin("read", "points");
  EXPECT_NO_THROW(watch_.check());
  stop_.request_stop();
  EXPECT_THROW(watch_.check(), Interrupted);
  EXPECT_THROW(watch_.tell(1, std::nullopt), Interrupted);
  EXPECT_THROW(watch_.tell_nested(1, std::nullopt), Interrupted);
  EXPECT_THROW(watch_.begin("write", "triangles"), Interrupted);
  EXPECT_THROW(watch_.open("write", "triangles"), Interrupted);
}

TEST_F(RunWatchTest, WhatIsDoneIsToldThoughTheRunIsToStop) {
  watch_.begin("read", "points");
  stop_.request_stop();
  EXPECT_NO_THROW(watch_.end(10));
  EXPECT_EQ(events_.back(), (Told{Event::kEnded, "read", "points", 10, 1.0}));
}

TEST_F(RunWatchTest, ManyThreadsTellOneCallAtATimeAndNeverLess) {
  watch_.begin("read", "points");
  std::atomic<std::uint64_t> done = 0;
  {
    std::vector<std::jthread> threads;
    for (int t = 0; t < 4; ++t) {
      threads.emplace_back([this, &done] {
        for (int i = 0; i < 200; ++i) watch_.tell(++done, std::nullopt);
      });
    }
  }
  watch_.end(done);
  EXPECT_THAT(events_, SizeIs(::testing::AllOf(::testing::Ge(3U), ::testing::Le(802U))));
  for (std::size_t e = 1; e < events_.size(); ++e) {
    EXPECT_GE(events_[e].done, events_[e - 1].done);
  }
  EXPECT_EQ(events_.back().done, 800U);
}

TEST(RunWatch, WhatTheProgramThrowsReachesItAndTheWatchGoesOn) {
  ContextOptions options;
  int told = 0;
  options.progress = [&told](const Progress& progress) {
    ++told;
    if (progress.event == Event::kUpdated) throw std::out_of_range("of the program");
  };
  const Context context(options);
  RunWatch watch(context);
  watch.begin("read", "points");
  EXPECT_THROW(watch.tell(1, std::nullopt), std::out_of_range);
  EXPECT_THROW(watch.tell_nested(1, std::nullopt), std::out_of_range);
  EXPECT_NO_THROW(watch.end(1));
  EXPECT_EQ(told, 4);
}

TEST(RunWatch, OfAProgramThatIsToldNothingIsStoppedAllTheSame) {
  std::stop_source stop;
  ContextOptions options;
  options.stop = stop.get_token();
  const Context context(options);
  RunWatch watch(context);
  watch.begin("read", "points");
  watch.tell(1, std::nullopt);
  stop.request_stop();
  EXPECT_THROW(watch.tell(2, std::nullopt), Interrupted);
}

}  // namespace
}  // namespace spillway::test
