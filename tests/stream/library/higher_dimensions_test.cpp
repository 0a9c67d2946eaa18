// Points and meshes of four to six dimensions through the door for programs: coordinates beyond z
// go in and out as attributes.

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <spillway/check.h>
#include <spillway/convert.h>
#include <spillway/delaunay.h>
#include <spillway/generate.h>
#include <spillway/info.h>
#include <spillway/triangulate.h>

#include <algorithm>
#include <array>
#include <fstream>
#include <functional>
#include <limits>
#include <optional>
#include <random>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "tests/stream/library/call_test.h"

namespace spillway::test {
namespace {

using ::testing::HasSubstr;

template <int D>
std::vector<Point<D>> random_points(std::size_t count) {
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> coordinate(-3, 5);
  std::vector<Point<D>> points(count);
  for (auto& point : points) {
    for (double& x : point) x = coordinate(random);
  }
  return points;
}

template <int D>
using Corners = std::set<std::set<Point<D>>>;

template <int D>
Corners<D> simplices_of(const MeshInMemory& mesh) {
  const std::vector<Point<D>> vertices = mesh.coordinates<D>();
  Corners<D> all;
  for (std::size_t c = 0; c < mesh.corners().size(); c += D + 1) {
    std::set<Point<D>> simplex;
    for (int i = 0; i <= D; ++i) simplex.insert(vertices[mesh.corners()[c + i]]);
    all.insert(simplex);
  }
  return all;
}

template <int D>
Corners<D> simplices_in_memory(const std::vector<Point<D>>& points) {
  const Delaunay<D> mesh(points);
  Corners<D> all;
  const auto corners = mesh.cell_vertices();
  for (std::size_t c = 0; c < corners.size(); c += D + 1) {
    std::set<Point<D>> simplex;
    for (int i = 0; i <= D; ++i) simplex.insert(points[corners[c + i]]);
    all.insert(simplex);
  }
  return all;
}

/// A program's own points: x, y and z, and an attribute for each coordinate beyond.
class OwnHigherPoints : public PointSource {
 public:
  explicit OwnHigherPoints(std::vector<Point<5>> points, NumberType type = NumberType::kFloat64)
      : points_(std::move(points)), type_(type) {}

  [[nodiscard]] PointsHeader header() const override {
    return {.attributes = {{.name = "x5", .type = type_}, {.name = "weight"}, {.name = "x4"}}};
  }
  bool read(std::vector<Point<3>>& /*points*/) override { return false; }
  bool read(PointsBlock& block) override {
    block.points.clear();
    if (is_read_) return false;
    is_read_ = true;
    block.attributes = AttributeColumns(header().attributes, points_.size());
    for (std::size_t i = 0; i < points_.size(); ++i) {
      const Point<5>& p = points_[i];
      block.points.push_back({p[0], p[1], p[2]});
      block.attributes.values<double>("x4")[i] = p[3];
      block.attributes.values<double>("x5")[i] = p[4];
      block.attributes.values<double>("weight")[i] = p[0] + p[4];
    }
    return true;
  }

 private:
  std::vector<Point<5>> points_;
  NumberType type_;
  bool is_read_ = false;
};

class HigherDimensionsOfStreams : public CallTest {
 protected:
  HigherDimensionsOfStreams() {
    ContextOptions how = options();
    how.memory = "512M";
    context_.emplace(how);
  }
  template <int D>
  void expect_mesh_of_array(std::size_t count) {
    const auto points = random_points<D>(count);
    const auto source = points_in_memory(PointView<D>(points));
    MeshInMemory mesh;
    TriangulateOptions how;
    how.dimension = D;
    how.tile_points = count / 4;
    const Report report = triangulate(*source, mesh, how, *context_);
    EXPECT_EQ(report.dimension, D);
    EXPECT_EQ(mesh.header().dimension, D);
    EXPECT_EQ(simplices_of<D>(mesh), simplices_in_memory<D>(points));
  }
  std::string message_of(const std::function<void()>& call) {
    try {
      call();
    } catch (const Error& error) {
      return error.what();
    }
    return "";
  }

  std::optional<Context> context_;
};

TEST_F(HigherDimensionsOfStreams, OfArraysHaveTheSimplicesOfDelaunay) {
  expect_mesh_of_array<4>(400);
  expect_mesh_of_array<5>(120);
  expect_mesh_of_array<6>(60);
}

TEST_F(HigherDimensionsOfStreams, OfAProgramsOwnSourceAreTakenByName) {
  const auto points = random_points<5>(100);
  OwnHigherPoints source(points);
  MeshInMemory mesh({"weight"});
  triangulate(source, mesh, {.dimension = 5}, *context_);
  EXPECT_EQ(simplices_of<5>(mesh), simplices_in_memory<5>(points));
  const auto vertices = mesh.coordinates<5>();
  const auto weights = mesh.attributes().values<double>("weight");
  for (std::size_t v = 0; v < vertices.size(); ++v) {
    EXPECT_EQ(weights[v], vertices[v][0] + vertices[v][4]);
  }
  OwnHigherPoints narrow(points, NumberType::kInt32);
  EXPECT_THAT(message_of([&] { triangulate(narrow, mesh, {.dimension = 5}, *context_); }),
              HasSubstr("coordinate 5 of points of 5 dimensions is an attribute of one float64"));
}

TEST_F(HigherDimensionsOfStreams, PassThroughFilesAndAreProved) {
  const auto points = random_points<4>(300);
  const auto source = points_in_memory(std::vector<Point<4>>(points));
  const auto sink = create_points(file("points.npy"), {}, *context_);
  convert(*source, *sink, *context_);
  PointOptions of_four;
  of_four.dimension = 4;
  auto read = open_points({file("points.npy")}, of_four, *context_);
  const auto mesh_file = create_mesh(file("mesh.spm"), {}, *context_);
  triangulate(*read, *mesh_file, {.dimension = 4}, *context_);
  const MeshInfo info = describe_mesh(file("mesh.spm"), {}, *context_);
  EXPECT_EQ(info.dimension, 4);
  ASSERT_EQ(info.further_extent.size(), 1U);
  const auto [least, largest] =
      std::ranges::minmax_element(points, {}, [](auto& p) { return p[3]; });
  EXPECT_EQ(info.further_extent[0], (std::array{(*least)[3], (*largest)[3]}));
  const auto mesh = open_mesh(file("mesh.spm"), {}, *context_);
  const auto same = points_in_memory(PointView<4>(points));
  const CheckReport found = check(*mesh, {}, *context_, same.get());
  EXPECT_EQ(found.fault_count, 0U) << found.faults.front();
}

TEST_F(HigherDimensionsOfStreams, OfMeshesOfAProgramAreWritten) {
  const auto points = random_points<4>(200);
  const auto source = points_in_memory(PointView<4>(points));
  const auto file_of_mesh = create_mesh(file("a.spm"), {}, *context_);
  class Both : public MeshSink {
   public:
    explicit Both(MeshSink& file) : file_(file) {}
    void begin(const MeshHeader& header) override { file_.begin(header); }
    void write(const MeshBlock& block) override { file_.write(block); }
    void finish(const MeshTotals& totals) override { file_.finish(totals); }

   private:
    MeshSink& file_;
  } own(*file_of_mesh);
  triangulate(*source, own, {.dimension = 4}, *context_);
  EXPECT_EQ(describe_mesh(file("a.spm"), {}, *context_).totals.vertices, 200U);
  const auto mesh = open_mesh(file("a.spm"), {}, *context_);
  EXPECT_EQ(check(*mesh, {}, *context_).fault_count, 0U);
}

TEST_F(HigherDimensionsOfStreams, GoBeforeTheAttributesThatAFileKeeps) {
  const auto points = random_points<4>(40);
  AttributeColumns given({{.name = "w"}, {.name = "v"}}, points.size());
  for (std::size_t i = 0; i < points.size(); ++i) given.values<double>("v")[i] = 0.5 * points[i][3];
  const auto source = points_in_memory(PointView<4>(points), given);
  const auto sink = create_points(file("a.spp"), {.attributes = {{"v"}}}, *context_);
  convert(*source, *sink, *context_);
  const auto again =
      open_points({file("a.spp")}, {.dimension = 0, .attributes = {"all"}}, *context_);
  PointsBlock block;
  ASSERT_TRUE(again->read(block));
  ASSERT_EQ(block.attributes.attributes().size(), 2U);
  for (std::size_t i = 0; i < block.points.size(); ++i) {
    EXPECT_EQ(block.attributes.values<double>("x4")[i], points[i][3]);
    EXPECT_EQ(block.attributes.values<double>("v")[i], 0.5 * points[i][3]);
  }
}

TEST_F(HigherDimensionsOfStreams, OfMeshesAreKeptByWhoWantsNoAttributes) {
  const auto points = random_points<4>(60);
  const auto source = points_in_memory(PointView<4>(points));
  const auto file_of_mesh = create_mesh(file("a.spm"), {}, *context_);
  triangulate(*source, *file_of_mesh, {.dimension = 4}, *context_);
  MeshInMemory mesh;
  convert(*open_mesh(file("a.spm"), {}, *context_), mesh, *context_);
  EXPECT_EQ(simplices_of<4>(mesh), simplices_in_memory<4>(points));
}

TEST_F(HigherDimensionsOfStreams, ThatDoNotFitTheCallAreErrors) {
  const auto points = random_points<4>(50);
  MeshInMemory mesh;
  EXPECT_THAT(message_of([&] {
                triangulate(*points_in_memory(PointView<4>(points)), mesh, {.dimension = 5},
                            *context_);
              }),
              "the points have 4 dimensions, not 5");
  const auto in_space = random_points<3>(50);
  EXPECT_THAT(message_of([&] {
                triangulate(*points_in_memory(PointView<3>(in_space)), mesh, {.dimension = 4},
                            *context_);
              }),
              "the points have x, y and z, but are to be triangulated in 4 dimensions");
  EXPECT_THAT(message_of([&] {
                triangulate(*points_in_memory(PointView<4>(points)), mesh, {.dimension = 7},
                            *context_);
              }),
              "there are 2 to 6 dimensions, not 7");
  AttributeColumns weight({{.name = "weight"}}, in_space.size());
  MeshInMemory weighed({"weight"});
  EXPECT_THAT(message_of([&] {
                triangulate(*points_in_memory(PointView<3>(in_space), weight), weighed,
                            {.dimension = 4}, *context_);
              }),
              "the points have x, y and z, but are to be triangulated in 4 dimensions");
  std::ofstream(file("in.csv")) << "x,y,z,x4\n1,2,3,4\n";
  const auto not_for_four = open_points({file("in.csv")}, {.dimension = 0}, *context_);
  EXPECT_THAT(message_of([&] { triangulate(*not_for_four, mesh, {.dimension = 4}, *context_); }),
              HasSubstr("open them for 4 dimensions"));
  auto bad = points;
  bad[9][3] = std::numeric_limits<double>::infinity();
  EXPECT_THAT(message_of([&] {
                triangulate(*points_in_memory(PointView<4>(bad)), mesh, {.dimension = 4},
                            *context_);
              }),
              HasSubstr("point 9 has a coordinate that is not finite"));
  AttributeColumns taken({{.name = "x4"}}, points.size());
  EXPECT_THAT(message_of([&] { points_in_memory(PointView<4>(points), taken); }),
              HasSubstr("an attribute is called x4, as a coordinate of the points is"));
  triangulate(*points_in_memory(PointView<4>(points)), mesh, {.dimension = 4}, *context_);
  const auto of_four = create_mesh(file("four.spm"), {}, *context_);
  triangulate(*points_in_memory(PointView<4>(points)), *of_four, {.dimension = 4}, *context_);
  const auto others = generate_points({.family = "uniform", .count = 50, .dimension = 5});
  EXPECT_THAT(message_of([&] {
                check(*open_mesh(file("four.spm"), {}, *context_), {}, *context_, others.get());
              }),
              HasSubstr("opened for 5 dimensions"));
  EXPECT_THAT(message_of([&] { static_cast<void>(mesh.coordinates<5>()); }),
              "a mesh of 4 dimensions has no coordinate 5");
  PointOptions thin;
  thin.dimension = 4;
  thin.thin.emplace();
  EXPECT_THAT(message_of([&] { open_points({file("a.npy")}, thin, *context_); }),
              HasSubstr("thinned by cells of 2 or 3 dimensions"));
}

}  // namespace
}  // namespace spillway::test
