// The words of a proof.

#include "stream/checker/fault_text.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

namespace spillway::test {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

TEST(FaultText, NamesVerticesByNumberAndCoordinates) {
  EXPECT_EQ(vertex_text<2>({7, {1.5, 2}}), "vertex 7 (1.5, 2)");
  EXPECT_EQ(vertex_text<3>({0, {-1, 0.25, 1e300}}), "vertex 0 (-1, 0.25, 1e+300)");
  EXPECT_EQ((list_text<2, 2>({{{5, {0, 0}}, {7, {1, 0}}}})), "5, 7 at (0, 0), (1, 0)");
}

TEST(FaultText, NamesSimplicesByTheirDimension) {
  EXPECT_EQ(simplex_text<2>(3, {{{5, {0, 0}}, {6, {1, 0}}, {7, {0, 1}}}}),
            "triangle 3 (vertices 5, 6, 7 at (0, 0), (1, 0), (0, 1))");
  EXPECT_EQ(simplex_text<3>(9, {{{1, {0, 0, 0}}, {2, {1, 0, 0}}, {3, {0, 1, 0}}, {4, {0, 0, 1}}}}),
            "tetrahedron 9 (vertices 1, 2, 3, 4 at (0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1))");
}

/// 0.1 and the double after it differ in text, so that a reader finds the vertex meant.
TEST(FaultText, TellsNeighbouringCoordinatesApart) {
  const double next = std::nextafter(0.1, 1.0);
  EXPECT_NE(vertex_text<2>({1, {0.1, 0}}), vertex_text<2>({1, {next, 0}}));
}

TEST(Faults, AreAllCountedAndDescribedWhileTheyAreFew) {
  CheckReport report;
  Faults faults(report, 2);
  for (int fault = 0; fault < 5; ++fault) faults.add("fault {}", fault);
  EXPECT_EQ(faults.count(), 5U);
  EXPECT_EQ(report.fault_count, 5U);
  EXPECT_THAT(report.faults, ElementsAre("fault 0", "fault 1"));
}

TEST(Faults, OfAnotherReportFollowInTheirOrder) {
  CheckReport part;
  part.fault_count = 9;
  part.faults = {"b", "c", "d"};
  CheckReport report;
  Faults faults(report, 3);
  faults.add("a");
  faults.add(part);
  EXPECT_EQ(report.fault_count, 10U);
  EXPECT_THAT(report.faults, ElementsAre("a", "b", "c"));
}

TEST(Faults, OfWhichNoneAreWantedAreCountedOnly) {
  CheckReport report;
  Faults faults(report, 0);
  faults.add("a");
  EXPECT_EQ(report.fault_count, 1U);
  EXPECT_THAT(report.faults, IsEmpty());
}

}  // namespace
}  // namespace spillway::test
