// What points carry, in and out of a program.

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <spillway/convert.h>
#include <spillway/points.h>

#include <cstdint>
#include <memory>
#include <random>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "tests/stream/library/call_test.h"

namespace spillway {
namespace {

using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

std::vector<Attribute> some_attributes() {
  return {{.name = "classification", .type = NumberType::kUint8},
          {.name = "gps_time", .type = NumberType::kFloat64},
          {.name = "depth", .type = NumberType::kInt32},
          {.name = "normal", .type = NumberType::kFloat32, .elements = 3}};
}

PointsBlock some_points(std::size_t count) {
  std::mt19937 random(11);
  PointsBlock block;
  block.attributes = AttributeColumns(some_attributes(), count);
  for (std::size_t i = 0; i < count; ++i) {
    block.points.push_back({static_cast<double>(random() % 1000), static_cast<double>(i), 3});
    block.attributes.values<std::uint8_t>("classification")[i] = random() % 32;
    block.attributes.values<double>("gps_time")[i] = static_cast<double>(random()) / 64;
    block.attributes.values<std::int32_t>("depth")[i] = static_cast<std::int32_t>(random());
  }
  for (float& number : block.attributes.values<float>("normal")) {
    number = static_cast<float>(random() % 100) / 8;
  }
  return block;
}

/// A program's own source of some blocks.
class CarryingPoints final : public PointSource {
 public:
  explicit CarryingPoints(std::vector<PointsBlock> blocks) : blocks_(std::move(blocks)) {}

  [[nodiscard]] PointsHeader header() const override { return {.attributes = told}; }
  bool read(std::vector<Point<3>>& points) override {
    PointsBlock block;
    if (!read(block)) return false;
    points = std::move(block.points);
    return true;
  }
  bool read(PointsBlock& block) override {
    if (next_ == blocks_.size()) return false;
    block = blocks_[next_++];
    return true;
  }

  std::vector<Attribute> told = some_attributes();

 private:
  std::vector<PointsBlock> blocks_;
  std::size_t next_ = 0;
};

/// A program's own sink, which asks for attributes.
class CarriedPoints final : public PointSink {
 public:
  explicit CarriedPoints(std::vector<std::string> wanted) : wanted_(std::move(wanted)) {}

  [[nodiscard]] std::vector<std::string> attributes_wanted() const override { return wanted_; }
  void begin(const PointsHeader& told) override {
    header = told;
    all.attributes = AttributeColumns(told.attributes);
  }
  void write(std::span<const Point<3>> points) override { write(points, {}); }
  void write(std::span<const Point<3>> points, const AttributeColumns& attributes) override {
    all.points.insert(all.points.end(), points.begin(), points.end());
    all.attributes.append(attributes);
  }

  PointsHeader header;
  PointsBlock all;

 private:
  std::vector<std::string> wanted_;
};

/// Passes on what it gets, as a filter of a program does.
class PassedOn final : public PointSink {
 public:
  explicit PassedOn(PointSink& to) : to_(to) {}

  [[nodiscard]] std::vector<std::string> attributes_wanted() const override {
    return to_.attributes_wanted();
  }
  void begin(const PointsHeader& header) override { to_.begin(header); }
  void write(std::span<const Point<3>> points) override { to_.write(points); }
  void write(std::span<const Point<3>> points, const AttributeColumns& attributes) override {
    to_.write(points, attributes);
  }
  void finish() override { to_.finish(); }

 private:
  PointSink& to_;
};

/// The same numbers of an attribute, maybe of other types.
void expect_same(const AttributeColumns& found, const AttributeColumns& expected,
                 const std::string& name) {
  EXPECT_EQ(found.meant(name), expected.meant(name)) << name;
}

class Attributes : public test::CallTest {
 protected:
  PointsBlock read(const std::string& name, const std::vector<std::string>& wanted) {
    const auto source = open_points({file(name)}, {.attributes = wanted}, Context(options()));
    PointsBlock all;
    all.attributes = AttributeColumns(source->header().attributes);
    for (PointsBlock block; source->read(block);) {
      all.points.insert(all.points.end(), block.points.begin(), block.points.end());
      all.attributes.append(block.attributes);
    }
    return all;
  }

  PointConversion write(PointSource& source, const std::string& name) {
    const Context context(options());
    return convert(source, *create_points(file(name), {}, context), context);
  }

  /// What a call with these points says is wrong with them.
  std::string refusal(const std::vector<Attribute>& told, const PointsBlock& block) {
    CarryingPoints source({block});
    source.told = told;
    try {
      write(source, "refused.spp");
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::kInvalidArgument);
      return error.what();
    }
    return "";
  }
};

TEST_F(Attributes, OfAProgramComeBackFromFilesOfAllFormatsThatHoldThem) {
  const PointsBlock all = some_points(500);
  for (const std::string name : {"points.las", "points.laz", "points.copc.laz", "points.spp"}) {
    CarryingPoints source({all});
    EXPECT_THAT(write(source, name).lost, IsEmpty()) << name;
    const PointsBlock found = read(name, {"classification", "gps_time", "depth", "normal"});
    ASSERT_EQ(found.points.size(), all.points.size()) << name;
    if (name == "points.copc.laz") continue;  // has an order of its own
    EXPECT_EQ(found.points, all.points) << name;
    for (const Attribute& attribute : some_attributes()) {
      expect_same(found.attributes, all.attributes, attribute.name);
    }
  }
}

TEST_F(Attributes, OfAProgramAreColumnsOfTablesAndNamesOfNumpy) {
  const PointsBlock all = some_points(100);
  for (const std::string name : {"points.csv", "points.npy", "points.ply"}) {
    CarryingPoints source({all});
    EXPECT_THAT(write(source, name).lost, IsEmpty()) << name;
    const PointsBlock found = read(name, {"all"});
    ASSERT_EQ(found.points, all.points) << name;
    for (const std::string attribute : {"classification", "gps_time", "depth"}) {
      expect_same(found.attributes, all.attributes, attribute);
    }
  }
}

TEST_F(Attributes, OfSeveralBlocksStayWithTheirPoints) {
  const PointsBlock all = some_points(90);
  std::vector<PointsBlock> blocks;
  for (std::size_t first = 0; first < 90; first += 30) {
    PointsBlock block;
    block.points.assign(all.points.begin() + static_cast<std::ptrdiff_t>(first),
                        all.points.begin() + static_cast<std::ptrdiff_t>(first + 30));
    block.attributes = AttributeColumns(some_attributes(), 30);
    for (std::size_t i = 0; i < 30; ++i) {
      block.attributes.values<std::int32_t>("depth")[i] =
          all.attributes.values<std::int32_t>("depth")[first + i];
    }
    blocks.push_back(std::move(block));
  }
  CarryingPoints source(blocks);
  CarriedPoints sink({"depth"});
  convert(source, sink, Context(options()));
  EXPECT_EQ(sink.all.points, all.points);
  expect_same(sink.all.attributes, all.attributes, "depth");
}

TEST_F(Attributes, OfFilesReachASinkThatAsksForThemByName) {
  const PointsBlock all = some_points(300);
  CarryingPoints source({all});
  write(source, "points.laz");
  const Context context(options());
  CarriedPoints sink({"Class", "depth", "unknown"});
  convert(*open_points({file("points.laz")}, {}, context), sink, context);
  EXPECT_EQ(sink.header.attributes.size(), 2U);
  EXPECT_EQ(sink.all.points, all.points);
  expect_same(sink.all.attributes, all.attributes, "classification");
  expect_same(sink.all.attributes, all.attributes, "depth");
  EXPECT_EQ(sink.all.attributes.values<std::uint8_t>("classification").size(), 300U);
}

TEST_F(Attributes, AreNotToldOfWhereNobodyAsksForThem) {
  CarryingPoints source({some_points(20)});
  write(source, "points.las");
  const Context context(options());
  const auto points = open_points({file("points.las")}, {}, context);
  EXPECT_THAT(points->header().attributes, IsEmpty());
  test::OwnSink sink;
  convert(*points, sink, context);
  EXPECT_THAT(sink.header.attributes, IsEmpty());
  EXPECT_EQ(sink.points.size(), 20U);
}

TEST_F(Attributes, PassASinkInBetween) {
  const PointsBlock all = some_points(50);
  const Context context(options());
  CarryingPoints source({all});
  const auto file_sink = create_points(file("points.las"), {}, context);
  PassedOn between(*file_sink);
  convert(source, between, context);
  expect_same(read("points.las", {"all"}).attributes, all.attributes, "depth");
  CarryingPoints other({all});
  const auto table = create_points(file("points.csv"), {.attributes = {{"depth"}}}, context);
  EXPECT_THAT(table->attributes_wanted(), ElementsAre("depth"));
  PassedOn before(*table);
  convert(other, before, context);
  EXPECT_THAT(read("points.csv", {"all"}).attributes.attributes(),
              ElementsAre(::testing::Field(&Attribute::name, "depth")));
}

TEST_F(Attributes, OfPointsInMemoryAreReadAndWritten) {
  const PointsBlock all = some_points(70'000);
  const auto read_in_blocks = points_in_memory(PointView<3>(all.points), all.attributes);
  AttributeColumns found(read_in_blocks->header().attributes);
  for (PointsBlock block; read_in_blocks->read(block);) found.append(block.attributes);
  EXPECT_EQ(found.size(), all.points.size());
  expect_same(found, all.attributes, "normal");
  write(*points_in_memory(std::vector(all.points), all.attributes), "points.spp");
  expect_same(read("points.spp", {"depth"}).attributes, all.attributes, "depth");
  const AttributeColumns few(some_attributes(), 7);
  EXPECT_EQ(code_of([&] { points_in_memory(PointView<3>(all.points), few); }),
            ErrorCode::kInvalidArgument);
}

TEST_F(Attributes, OfFilesThatNoneHasAreRefusedByName) {
  CarryingPoints source({some_points(20)});
  write(source, "points.las");
  try {
    open_points({file("points.las")}, {.attributes = {"colour"}}, Context(options()));
    FAIL() << "colour is no attribute of theirs";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::kInvalidArgument);
    EXPECT_THAT(error.what(), HasSubstr("no attribute \"colour\": choose of "));
  }
}

TEST_F(Attributes, ThatAFileLosesAreNamed) {
  CarryingPoints source({some_points(20)});
  const Context context(options());
  const PointConversion done = convert(
      source, *create_points(file("points.npy"), {.attributes = {{"depth"}}}, context), context);
  EXPECT_THAT(done.lost, ElementsAre("classification", "gps_time", "normal"));
  CarryingPoints again({some_points(20)});
  EXPECT_EQ(code_of([&] {
              convert(again, *create_points(file("a.npy"), {.attributes = {{"colour"}}}, context),
                      context);
            }),
            ErrorCode::kInvalidArgument);
}

TEST_F(Attributes, OfAProgramAreRefusedUnlessBlocksHaveWhatTheHeaderTells) {
  const PointsBlock all = some_points(3);
  EXPECT_EQ(refusal(some_attributes(), all), "");
  PointsBlock bare = all;
  bare.attributes = {};
  EXPECT_THAT(refusal(some_attributes(), bare), HasSubstr("without attribute \"classification\""));
  EXPECT_THAT(refusal({some_attributes()[0]}, all), HasSubstr("attribute \"gps_time\""));
  PointsBlock fewer = all;
  fewer.attributes.resize(2);
  EXPECT_THAT(refusal(some_attributes(), fewer), HasSubstr("3 points, but attributes of 2"));
  std::vector<Attribute> twice = some_attributes();
  twice.push_back(twice.front());
  EXPECT_THAT(refusal(twice, all), HasSubstr("called \"classification\""));
}

TEST_F(Attributes, ThatAFormatCannotHoldNameThePoint) {
  PointsBlock wrong;
  wrong.points = {{0, 0, 0}, {1, 1, 1}};
  wrong.attributes = AttributeColumns({{.name = "intensity", .type = NumberType::kInt32}}, 2);
  wrong.attributes.values<std::int32_t>("intensity")[1] = -5;
  const auto source = points_in_memory(PointView<3>(wrong.points), wrong.attributes);
  try {
    write(*source, "wrong.las");
    FAIL() << "intensities are not negative in LAS";
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), HasSubstr("intensity"));
    EXPECT_THAT(error.what(), HasSubstr("-5"));
    EXPECT_EQ(error.facts().remedy, Remedy::kAttributes) << "programs have no options of a command";
  }
}

TEST_F(Attributes, AreWrittenByAProgramThatCallsAFileItself) {
  const PointsBlock all = some_points(40);
  const Context context(options());
  const auto sink = create_points(file("points.las"), {}, context);
  sink->begin({.extent = Extent{{0, 0, 0}, {1000, 40, 3}}, .attributes = some_attributes()});
  sink->write(all.points, all.attributes);
  EXPECT_EQ(code_of([&] { sink->write(all.points); }), ErrorCode::kInvalidArgument);
  sink->finish();
  const PointsBlock found = read("points.las", {"all"});
  expect_same(found.attributes, all.attributes, "depth");
  expect_same(found.attributes, all.attributes, "classification");
}

/// Two triangles of a program, in two blocks.
class CarryingMesh final : public MeshSource {
 public:
  explicit CarryingMesh(const PointsBlock& vertices) {
    first_.vertices.assign(vertices.points.begin(), vertices.points.begin() + 3);
    first_.attributes = vertices.attributes;
    first_.attributes.resize(3);
    first_.corners = {0, 1, 2};
    first_.finalized = {0};
    second_.first_vertex = 3;
    second_.vertices = {vertices.points[3]};
    second_.attributes = AttributeColumns(vertices.attributes.attributes(), 1);
    second_.attributes.values<std::int32_t>("depth")[0] =
        vertices.attributes.values<std::int32_t>("depth")[3];
    second_.corners = {1, 3, 2};
    second_.finalized = {1, 2, 3};
  }

  [[nodiscard]] MeshHeader header() const override {
    return {.attributes = first_.attributes.attributes()};
  }
  bool read(MeshBlock& block) override {
    if (next_ == 2) return false;
    block = next_++ == 0 ? first_ : second_;
    return true;
  }
  [[nodiscard]] MeshTotals totals() override { return {}; }

 private:
  MeshBlock first_;
  MeshBlock second_;
  int next_ = 0;
};

PointsBlock corners_of_a_square() {
  PointsBlock corners = some_points(4);
  corners.points = {{0, 0, 1}, {1, 0, 2}, {0, 1, 3}, {1, 1, 4}};
  return corners;
}

TEST_F(Attributes, OfAMeshReachTheSinkThatAsksForThem) {
  const PointsBlock corners = corners_of_a_square();
  CarryingMesh some_of_them(corners);
  MeshInMemory depths({"depth", "unknown"});
  convert(some_of_them, depths, Context(options()));
  EXPECT_EQ(depths.header().attributes.size(), 1U);
  expect_same(depths.attributes(), corners.attributes, "depth");
  EXPECT_EQ(depths.vertices(), corners.points);
  CarryingMesh all_of_them(corners);
  MeshInMemory all({"all"});
  convert(all_of_them, all, Context(options()));
  EXPECT_EQ(all.attributes().attributes(), some_attributes());
}

TEST_F(Attributes, OfAMeshDoNotComeToASinkThatDoesNotAsk) {
  CarryingMesh mesh(corners_of_a_square());
  int blocks = 0;
  const auto sink = mesh_to([&](const MeshBlock& block) {
    EXPECT_TRUE(block.attributes.empty());
    ++blocks;
  });
  convert(mesh, *sink, Context(options()));
  EXPECT_EQ(blocks, 2);
  CarryingMesh again(corners_of_a_square());
  MeshInMemory kept;
  convert(again, kept, Context(options()));
  EXPECT_TRUE(kept.attributes().empty());
}

TEST_F(Attributes, OfAMeshAreRefusedUnlessBlocksHaveWhatTheHeaderTells) {
  const PointsBlock corners = corners_of_a_square();
  MeshBlock block{.vertices = corners.points};
  const auto sink = create_mesh(file("mesh.spm"), {}, Context(options()));
  sink->begin({.attributes = some_attributes()});
  EXPECT_EQ(code_of([&] { sink->write(block); }), ErrorCode::kInvalidArgument);
  const auto other = create_mesh(file("other.spm"), {}, Context(options()));
  EXPECT_EQ(code_of([&] { other->begin({.attributes = {Attribute{.name = ""}}}); }),
            ErrorCode::kInvalidArgument);
}

}  // namespace
}  // namespace spillway
