// The proof of meshes that programs have: <spillway/check.h>.

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <spillway/check.h>
#include <spillway/generate.h>
#include <spillway/triangulate.h>

#include <algorithm>
#include <utility>

#include "tests/stream/library/call_test.h"

namespace spillway {
namespace {

using test::OwnPoints;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

/// A program's own mesh: a square of two triangles.
class Square : public MeshSource {
 public:
  [[nodiscard]] MeshHeader header() const override { return {}; }
  bool read(MeshBlock& block) override {
    if (std::exchange(is_read_, true)) return false;
    block.vertices = {{0, 0, 0}, {2, 0, 0}, {2, 1, 0}, {0, 2, 0}};
    block.corners = corners;
    block.finalized = {0, 1, 2, 3};
    return true;
  }
  [[nodiscard]] MeshTotals totals() override { return {}; }

  std::vector<std::uint64_t> corners{0, 1, 2, 0, 2, 3};

 private:
  bool is_read_ = false;
};

class Check : public test::CallTest {
 protected:
  void make(const std::string& name, int dimension = 2) {
    const Context context(options());
    const auto mesh = create_mesh(file(name), {}, context);
    triangulate(*hills(), *mesh, {.dimension = dimension}, context);
    phases_.clear();
  }

  static std::unique_ptr<PointSource> hills() {
    return generate_points({.family = "terrain", .count = 3000});
  }
};

TEST_F(Check, ProvesFilesWhetherStreamsOrNot) {
  const Context context(options());
  for (const int dimension : {2, 3}) {
    std::uint64_t hash = 0;
    for (const char* name : {"hills.spm", "hills.ply"}) {
      make(name, dimension);
      const auto mesh = open_mesh(file(name), {}, context);
      EXPECT_EQ(mesh->header().dimension, dimension);
      const CheckReport report = check(*mesh, {}, context, hills().get());
      EXPECT_THAT(report.faults, IsEmpty());
      EXPECT_THAT(report.proved, Contains(HasSubstr("distinct points of the input")));
      EXPECT_EQ(report.points.read, 3000U);
      EXPECT_TRUE(report.on_lattice);
      if (hash != 0) {
        EXPECT_EQ(report.canonical_hash, hash);
      }
      hash = report.canonical_hash;
    }
  }
  EXPECT_THAT(phases_, ElementsAre("read mesh", "check", "read points", "compare"));
}

TEST_F(Check, TellsAProgramWhatIsWrongWithItsMesh) {
  const Context context(options());
  Square right;
  EXPECT_EQ(check(right, {}, context).fault_count, 0U);
  Square wrong;
  wrong.corners = {0, 1, 3, 1, 2, 3};
  const CheckReport report = check(wrong, {}, context);
  EXPECT_EQ(report.fault_count, 1U);
  EXPECT_EQ(report.simplices, 2U);
  Square undescribed;
  undescribed.corners = wrong.corners;
  EXPECT_THAT(check(undescribed, {.most_faults = 0}, context).faults, IsEmpty());
}

TEST_F(Check, ComparesWithAProgramsPoints) {
  const Context context(options());
  Square square;
  OwnPoints points({{0, 0, 0}, {2, 0, 0}, {2, 1, 0}, {0, 2, 7}, {9, 9, 9}});
  const CheckReport report = check(square, {}, context, &points);
  EXPECT_EQ(report.fault_count, 2U);
  EXPECT_THAT(report.faults, Contains(HasSubstr("input point 4 (9, 9) is no vertex")));
  EXPECT_THAT(report.faults, Contains(HasSubstr("has height 0")));
}

TEST_F(Check, RefusesPointsOfAnotherDimensionAndAFileThatIsNotThere) {
  make("hills.spm");
  const Context context(options());
  const auto mesh = open_mesh(file("hills.spm"), {}, context);
  const auto points = create_points(file("hills.las"), {}, context);
  points->begin({});
  points->write(std::vector<Point<3>>{{1, 2, 3}});
  points->finish();
  const auto space = open_points({file("hills.las")}, {.dimension = 3}, context);
  EXPECT_EQ(code_of([&] { check(*mesh, {}, context, space.get()); }), ErrorCode::kInvalidArgument);
  EXPECT_EQ(code_of([&] { check(*open_mesh(file("none.ply"), {}, context), {}, context); }),
            ErrorCode::kInputOutput);
  Square square;
  EXPECT_EQ(code_of([&] { check(square, {}, Context(stopped())); }), ErrorCode::kInterrupted);
}

}  // namespace
}  // namespace spillway
