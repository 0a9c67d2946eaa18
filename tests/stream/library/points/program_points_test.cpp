// A program's own points, as the pipeline takes them.

#include "stream/library/points/program_points.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "tests/error_facts.h"

namespace spillway::test {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

/// A source that gives these blocks.
class Blocks final : public PointSource {
 public:
  explicit Blocks(std::vector<std::vector<Point<3>>> blocks, PointsHeader header = {})
      : blocks_(std::move(blocks)), header_(std::move(header)) {}

  [[nodiscard]] PointsHeader header() const override { return header_; }
  bool read(std::vector<Point<3>>& points) override {
    if (next_ == blocks_.size()) return false;
    points = blocks_[next_++];
    return true;
  }

 private:
  std::vector<std::vector<Point<3>>> blocks_;
  PointsHeader header_;
  std::size_t next_ = 0;
};

TEST(ProgramPoints, OfASystemThatNobodyKnowsAreRefusedWhereAnOutputNeedsIt) {
  Blocks source({}, {.crs = "nonsense"});
  ProgramPoints points(source);
  points.settle_crs(CrsNeed::kNone);
  points.settle_crs(CrsNeed::kCodes);
  EXPECT_THROW(points.settle_crs(CrsNeed::kAll), Failure);
}

TEST(ProgramPoints, ComeAsTheyAreAndAreNumberedThrough) {
  Blocks source({{{0.5, 1, 2}, {3, 4, 5}}, {{6, 7, 8}}});
  ProgramPoints points(source);
  EXPECT_FALSE(points.lattice());
  SourcePiece piece;
  PointBlock block;
  ASSERT_TRUE(points.fetch(piece));
  points.decode(piece, block);
  EXPECT_THAT(block.points, ElementsAre(LatticePoint{0.5, 1, 2}, LatticePoint{3, 4, 5}));
  EXPECT_THAT(block.index, ElementsAre(0, 1));
  ASSERT_TRUE(points.fetch(piece));
  points.decode(piece, block);
  EXPECT_THAT(block.points, ElementsAre(LatticePoint{6, 7, 8}));
  EXPECT_THAT(block.index, ElementsAre(2));
  EXPECT_FALSE(points.fetch(piece));
  EXPECT_EQ(points.points_read(), 3U);
  EXPECT_EQ(points.counts(), PointCounts{.read = 3});
}

/// Pieces are decoded by other threads than fetch them, and not in their order.
TEST(ProgramPoints, OfAPieceStayWhatTheyAreWhileOthersAreFetched) {
  Blocks source({{{1, 1, 1}}, {{2, 2, 2}}});
  ProgramPoints points(source);
  SourcePiece first;
  SourcePiece second;
  ASSERT_TRUE(points.fetch(first));
  ASSERT_TRUE(points.fetch(second));
  PointBlock block;
  points.decode(second, block);
  EXPECT_THAT(block.points, ElementsAre(LatticePoint{2, 2, 2}));
  points.decode(first, block);
  EXPECT_THAT(block.points, ElementsAre(LatticePoint{1, 1, 1}));
}

TEST(ProgramPoints, ThatAreNotFiniteAreNamedByTheirNumberInTheInput) {
  for (const double wrong : {std::nan(""), std::numeric_limits<double>::infinity()}) {
    for (int axis = 0; axis < 3; ++axis) {
      Point<3> point{1, 2, 3};
      point[axis] = wrong;
      Blocks source({{{0, 0, 0}, {1, 0, 0}}, {{2, 0, 0}, point}});
      ProgramPoints points(source);
      SourcePiece piece;
      ASSERT_TRUE(points.fetch(piece));
      ASSERT_TRUE(points.fetch(piece));
      PointBlock block;
      const auto error = thrown_by([&] { points.decode(piece, block); });
      ASSERT_TRUE(error);
      EXPECT_EQ(error->code(), ErrorCode::kInvalidArgument);
      EXPECT_THAT(error->what(), HasSubstr("point 3 "));
    }
  }
}

TEST(ProgramPoints, TellTheRunWhatTheirHeaderSays) {
  const Context context;
  RunWatch watch(context);
  Blocks source(
      {},
      {.coordinates = 2, .count = 70, .extent = Extent{{1, 2, 0}, {3, 4, 0}}, .crs = "EPSG:25832"});
  ProgramPoints points(source);
  const RunPoints run = points.begin(watch, true);
  EXPECT_EQ(run.stream, &points);
  EXPECT_FALSE(run.has_heights);
  EXPECT_FALSE(run.records) << "there may be fewer than the header counts";
  EXPECT_EQ(run.extent, (Box<3>{{1, 2, 0}, {3, 4, 0}}));
  EXPECT_EQ(run.crs, "EPSG:25832");
  EXPECT_EQ(points.expected(), 70U);
  EXPECT_EQ(points.extent(), run.extent);
}

TEST(ProgramPoints, HaveBeenReadByAShareThatIsNeverMoreThanAll) {
  Blocks source({{{0, 0, 0}, {1, 0, 0}}, {{2, 0, 0}, {3, 0, 0}}}, {.count = 3});
  ProgramPoints points(source);
  EXPECT_EQ(points.fraction_read(), 0);
  SourcePiece piece;
  points.fetch(piece);
  EXPECT_DOUBLE_EQ(points.fraction_read().value_or(0), 2.0 / 3);
  points.fetch(piece);
  EXPECT_EQ(points.fraction_read(), 1) << "one more has come than the header counts";
  Blocks unknown({{{0, 0, 0}}});
  EXPECT_FALSE(ProgramPoints(unknown).fraction_read());
  Blocks none({}, {.count = 0});
  EXPECT_FALSE(ProgramPoints(none).fraction_read());
}

TEST(ProgramPoints, RefuseAHeaderThatCannotBe) {
  const auto error_of = [](const PointsHeader& header) {
    Blocks source({}, header);
    return thrown_by([&] { const ProgramPoints points(source); });
  };
  EXPECT_FALSE(error_of({.extent = Extent{{0, 0, 0}, {1, 1, 0}}}));
  const double nan = std::nan("");
  const std::vector<PointsHeader> wrong = {{.coordinates = 1},
                                           {.coordinates = 4},
                                           {.extent = Extent{{0, nan, 0}, {1, 1, 1}}},
                                           {.extent = Extent{{0, 0, 0}, {1, 1, nan}}},
                                           {.extent = Extent{{0, 2, 0}, {1, 1, 1}}}};
  for (std::size_t w = 0; w < wrong.size(); ++w) {
    const auto error = error_of(wrong[w]);
    ASSERT_TRUE(error) << "header " << w;
    EXPECT_EQ(error->code(), ErrorCode::kInvalidArgument);
  }
}

TEST(RefuseTakenPoints, IsAnErrorOfTheProgramOnlyTheSecondTime) {
  EXPECT_FALSE(thrown_by([] { refuse_taken_points(false); }));
  const auto error = thrown_by([] { refuse_taken_points(true); });
  ASSERT_TRUE(error);
  EXPECT_EQ(error->code(), ErrorCode::kInvalidArgument);
}

}  // namespace
}  // namespace spillway::test
