// What a program may do wrong with sources and sinks is an error, and nothing else.

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <spillway/check.h>
#include <spillway/convert.h>
#include <spillway/error.h>
#include <spillway/generate.h>
#include <spillway/info.h>
#include <spillway/picture.h>
#include <spillway/triangulate.h>

#include <cmath>
#include <filesystem>
#include <functional>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "tests/stream/library/call_test.h"

namespace spillway::test {
namespace {

namespace fs = std::filesystem;

/// Two triangles of a square in two blocks, of which a test spoils one.
class Square : public MeshSource {
 public:
  [[nodiscard]] MeshHeader header() const override { return header_; }
  bool read(MeshBlock& block) override {
    if (next_ == blocks_.size()) return false;
    block = blocks_[next_++];
    return true;
  }
  [[nodiscard]] MeshTotals totals() override { return totals_; }

  MeshHeader header_{.extent = Extent{{0, 0, 0}, {1, 1, 9}}};
  std::vector<MeshBlock> blocks_ = {
      {.first_vertex = 0,
       .vertices = {{0, 0, 1}, {1, 0, 2}, {0, 1, 3}},
       .corners = {0, 1, 2},
       .finalized = {0}},
      {.first_vertex = 3, .vertices = {{1, 1, 4}}, .corners = {1, 3, 2}, .finalized = {1, 2, 3}}};
  MeshTotals totals_;

 private:
  std::size_t next_ = 0;
};

class Misuse : public CallTest {
 protected:
  void make_mesh(const std::string& name) {
    const auto points = generate_points({.family = "uniform", .count = 500});
    const auto mesh = create_mesh(file(name), {}, context_);
    triangulate(*points, *mesh, {}, context_);
  }

  /// Of sending the mesh to a file of that format and to a picture: which code both give.
  void expect_refused(const std::function<void(Square&)>& spoil, const char* why) {
    Square to_file;
    spoil(to_file);
    const auto ply = create_mesh(file("a.ply"), {}, context_);
    EXPECT_EQ(code_of([&] { convert(to_file, *ply, context_); }), ErrorCode::kInvalidArgument)
        << why;
    Square to_picture;
    spoil(to_picture);
    const auto picture = create_picture(file("a.png"), {.size = 32}, context_);
    EXPECT_EQ(code_of([&] { convert(to_picture, *picture, context_); }),
              ErrorCode::kInvalidArgument)
        << why;
  }

  const Context context_{options()};
};

TEST_F(Misuse, BlocksThatCannotBeAreRefusedByEverySink) {
  expect_refused([](Square& mesh) { mesh.blocks_[0].corners.pop_back(); }, "half a triangle");
  expect_refused([](Square& mesh) { mesh.blocks_[1].first_vertex = 0; }, "numbers from anew");
  expect_refused([](Square& mesh) { mesh.blocks_[1].corners[0] = 0; }, "a finalized vertex");
  expect_refused([](Square& mesh) { mesh.blocks_[1].corners[0] = 9; }, "a vertex to come");
  expect_refused([](Square& mesh) { mesh.blocks_[1].finalized = {1, 1}; }, "finalized twice");
  expect_refused([](Square& mesh) { mesh.header_.dimension = 4; }, "four dimensions");
  expect_refused([](Square& mesh) { mesh.header_.extent->high[0] = 0.5; }, "outside the extent");
  expect_refused([](Square& mesh) { mesh.header_.has_input_index = true; }, "no indices");
  expect_refused(
      [](Square& mesh) {
        mesh.blocks_[1].vertices[0][2] = std::numeric_limits<double>::quiet_NaN();
      },
      "a height that is none");
  expect_refused([](Square& mesh) { mesh.totals_.vertices = 7; }, "other totals");
  EXPECT_FALSE(fs::exists(file("a.ply")));
  EXPECT_FALSE(fs::exists(file("a.png")));
}

/// Of points whose header tells that: no file is made, as none that told it could be read.
TEST_F(Misuse, AnExtentOfPointsThatCannotBeIsRefused) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  const std::vector<Extent> wrong = {
      {{0, 0, 0}, {1, kInfinity, 1}}, {{0, 0, std::nan("")}, {1, 1, 1}}, {{0, 1, 0}, {1, 0, 1}}};
  for (const Extent& extent : wrong) {
    const std::vector<Point<3>> points{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    OwnPoints to_mesh(points, {.extent = extent});
    const auto mesh = create_mesh(file("a.spm"), {}, context_);
    EXPECT_EQ(code_of([&] { triangulate(to_mesh, *mesh, {}, context_); }),
              ErrorCode::kInvalidArgument);
    OwnPoints to_points(points, {.extent = extent});
    const auto copied = create_points(file("a.spp"), {}, context_);
    EXPECT_EQ(code_of([&] { convert(to_points, *copied, context_); }), ErrorCode::kInvalidArgument);
    const auto written = create_points(file("a.las"), {}, context_);
    EXPECT_EQ(code_of([&] { written->begin({.extent = extent}); }), ErrorCode::kInvalidArgument);
  }
  const auto written = create_points(file("a.las"), {}, context_);
  EXPECT_EQ(code_of([&] { written->begin({.coordinates = 4}); }), ErrorCode::kInvalidArgument);
  for (const char* const name : {"a.spm", "a.spp", "a.las"}) EXPECT_FALSE(fs::exists(file(name)));
}

TEST_F(Misuse, TotalsThatAreNotToldAreCounted) {
  Square square;
  const auto picture = create_picture(file("a.png"), {.size = 32}, context_);
  const Report report = convert(square, *picture, context_);
  EXPECT_EQ(report.mesh.vertices, 4U);
  EXPECT_EQ(report.mesh.simplices, 2U);
  Square again;
  const auto ply = create_mesh(file("a.ply"), {}, context_);
  convert(again, *ply, context_);
  EXPECT_EQ(describe_mesh(file("a.ply"), {}, context_).totals.vertices, 4U);
  Square for_spm;
  const auto spm = create_mesh(file("a.spm"), {}, context_);
  EXPECT_EQ(code_of([&] { convert(for_spm, *spm, context_); }), ErrorCode::kInvalidArgument)
      << "an spm file ends with a hash";
}

TEST_F(Misuse, ASourceIsReadOnceAndASinkTakesOneMesh) {
  make_mesh("mesh.spm");
  make_mesh("mesh.ply");
  for (const char* const name : {"mesh.spm", "mesh.ply"}) {
    const auto mesh = open_mesh(file(name), {}, context_);
    EXPECT_EQ(check(*mesh, {}, context_).fault_count, 0U);
    const auto picture = create_picture(file("a.png"), {.size = 32}, context_);
    EXPECT_EQ(code_of([&] { convert(*mesh, *picture, context_); }), ErrorCode::kInvalidArgument);
    const auto other = open_mesh(file(name), {}, context_);
    convert(*other, *picture, context_);
    const auto third = open_mesh(file(name), {}, context_);
    EXPECT_EQ(code_of([&] { convert(*third, *picture, context_); }), ErrorCode::kInvalidArgument);
  }
  const auto points = generate_points({.family = "uniform", .count = 100});
  MeshInMemory mesh;
  triangulate(*points, mesh, {}, context_);
  EXPECT_EQ(code_of([&] { triangulate(*points, mesh, {}, context_); }),
            ErrorCode::kInvalidArgument);
}

TEST_F(Misuse, AFileOfPointsIsNotWrittenOnAfterItsEnd) {
  const auto points = generate_points({.family = "uniform", .count = 100});
  const auto written = create_points(file("a.txt"), {}, context_);
  convert(*points, *written, context_);
  const auto size = fs::file_size(file("a.txt"));
  EXPECT_EQ(code_of([&] { written->finish(); }), ErrorCode::kInvalidArgument);
  const std::vector<Point<3>> more{{1, 2, 3}};
  EXPECT_EQ(code_of([&] { written->write(more); }), ErrorCode::kInvalidArgument);
  EXPECT_EQ(code_of([&] { written->begin({}); }), ErrorCode::kInvalidArgument);
  EXPECT_EQ(fs::file_size(file("a.txt")), size);
}

TEST_F(Misuse, OfOptionsThatLeaveNoPointsIsRefused) {
  EXPECT_THROW(open_points({file("p.txt")}, {.every = 0}, context_), Error);
  EXPECT_THROW(open_points({file("p.txt")}, {.max_expansion = 0}, context_), Error);
}

TEST_F(Misuse, OfALimitThatNoMeshIsWithinIsRefused) {
  make_mesh("mesh.spm");
  EXPECT_THROW(open_mesh(file("mesh.spm"), {.max_expansion = 0}, context_), Error);
}

TEST_F(Misuse, SourcesOutliveTheContextTheyWereOpenedWith) {
  make_mesh("mesh.spm");
  std::unique_ptr<PointSource> points;
  std::unique_ptr<MeshSource> mesh;
  {
    const Context gone(options());
    const auto made = generate_points({.family = "uniform", .count = 100});
    const auto written = create_points(file("p.txt"), {}, gone);
    convert(*made, *written, gone);
    points = open_points({file("p.txt")}, {}, gone);
    mesh = open_mesh(file("mesh.spm"), {}, gone);
  }
  MeshInMemory first;
  EXPECT_EQ(triangulate(*points, first, {}, context_).mesh.points, 100U);
  MeshInMemory second;
  EXPECT_GT(convert(*mesh, second, context_).mesh.simplices, 0U);
}

}  // namespace
}  // namespace spillway::test
