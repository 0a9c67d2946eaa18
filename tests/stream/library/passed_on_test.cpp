// What programs pass on is what they were given: a tee of a mesh, and a filter of points, make the
// same as the library's own, to the last bit.

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <spillway/check.h>
#include <spillway/convert.h>
#include <spillway/generate.h>
#include <spillway/triangulate.h>

#include <algorithm>
#include <filesystem>
#include <functional>
#include <memory>
#include <utility>

#include "formats/meshes/mesh_formats.h"
#include "tests/stream/library/call_test.h"
#include "tests/test_paths.h"

namespace spillway::test {
namespace {

using ::testing::HasSubstr;

/// Hands a mesh on to another sink, and counts.
class Tee : public MeshSink {
 public:
  explicit Tee(std::unique_ptr<MeshSink> next) : next_(std::move(next)) {}

  void begin(const MeshHeader& told) override { next_->begin(told); }
  void write(const MeshBlock& block) override {
    MeshBlock passed = block;
    if (drops_steps) passed.on_lattice.clear();
    next_->write(passed);
  }
  void finish(const MeshTotals& told) override {
    totals = told;
    next_->finish(told);
  }

  bool drops_steps = false;
  MeshTotals totals;

 private:
  std::unique_ptr<MeshSink> next_;
};

/// Gives the points of another source for which `wanted` holds.
class Filter : public PointSource {
 public:
  Filter(std::unique_ptr<PointSource> source, std::function<bool(const Point<3>&)> wanted)
      : source_(std::move(source)), wanted_(std::move(wanted)) {}

  [[nodiscard]] PointsHeader header() const override { return source_->header(); }
  bool read(std::vector<Point<3>>& points) override {
    do {
      if (!source_->read(points)) return false;
      std::erase_if(points, [this](const Point<3>& point) { return !wanted_(point); });
    } while (points.empty());
    return true;
  }

 private:
  std::unique_ptr<PointSource> source_;
  std::function<bool(const Point<3>&)> wanted_;
};

struct Given {
  std::string name;  ///< of a generator's family, or of a sample file
  int dimension = 2;
};

void PrintTo(const Given& given, std::ostream* out) { *out << given.name << given.dimension; }

class PassedOn : public CallTest, public ::testing::WithParamInterface<Given> {
 protected:
  void SetUp() override {
    const Given& given = GetParam();
    input_ = is_sample() ? (shared_data_folder() / given.name).string() : file("in.las");
    if (is_sample() && !std::filesystem::exists(input_)) GTEST_SKIP() << input_ << " is not there";
    if (is_sample()) return;
    const auto points = generate_points(
        {.family = given.name, .count = 1000, .dimension = given.dimension == 3 ? 3 : 2});
    convert(*points, *create_points(input_, {.scale = {0.01}}, context_), context_);
  }

  [[nodiscard]] static bool is_sample() { return GetParam().name.find('.') != std::string::npos; }
  [[nodiscard]] std::unique_ptr<PointSource> open() const {
    return open_points({input_}, {.dimension = GetParam().dimension}, context_);
  }
  [[nodiscard]] TriangulateOptions how() const {
    TriangulateOptions options;
    options.dimension = GetParam().dimension;
    return options;
  }
  std::uint64_t hash_of(PointSource& points) {
    const auto nothing = mesh_to([](const MeshBlock&) {});
    return triangulate(points, *nothing, how(), context_).mesh.canonical_hash;
  }

  const Context context_{options()};
  std::string input_;
};

TEST_P(PassedOn, MeshesAreWhatTheLibraryWritesInEveryFormat) {
  const std::uint64_t direct = hash_of(*open());
  for (const formats::MeshFormat* const format : formats::mesh_formats()) {
    const bool is_read = format->read != nullptr || format->open_stream != nullptr;
    const bool is_written = format->open_writer != nullptr || format->open_block_writer != nullptr;
    if (!is_read || !is_written || format->rounds_coordinates) continue;
    if (GetParam().dimension > format->most_dimension) continue;
    if (is_sample() && format->name != "spm" && format->name != "ply")
      continue;  // the others as well
    for (const bool drops_steps : {false, true}) {
      const std::string name(format->name);
      SCOPED_TRACE(name + (drops_steps ? " by coordinates" : ""));
      const std::string path = file("mesh." + name);
      Tee tee(create_mesh(path, {.format = name}, context_));
      tee.drops_steps = drops_steps;
      triangulate(*open(), tee, how(), context_);
      EXPECT_EQ(tee.totals.canonical_hash, direct);
      const auto mesh = open_mesh(path, {.format = name}, context_);
      const auto points = open();
      const CheckReport report = check(*mesh, {}, context_, points.get());
      EXPECT_EQ(report.fault_count, 0U)
          << (report.faults.empty() ? std::string() : report.faults.front());
      EXPECT_EQ(report.canonical_hash, direct);
    }
  }
}

TEST_P(PassedOn, MeshesThatAreReadAreWrittenAgainAsTheyWere) {
  const std::string path = file("mesh.spm");
  const std::uint64_t direct =
      triangulate(*open(), *create_mesh(path, {}, context_), how(), context_).mesh.canonical_hash;
  Tee tee(create_mesh(file("again.spm"), {}, context_));
  convert(*open_mesh(path, {}, context_), tee, context_);
  EXPECT_EQ(tee.totals.canonical_hash, direct);
  const auto again = open_mesh(file("again.spm"), {}, context_);
  EXPECT_EQ(again->header().lattice, open_mesh(path, {}, context_)->header().lattice);
  const CheckReport report = check(*again, {}, context_, nullptr);
  EXPECT_EQ(report.fault_count, 0U);
  EXPECT_EQ(report.canonical_hash, direct);
}

TEST_P(PassedOn, PointsMakeTheSameMesh) {
  Filter all(open(), [](const Point<3>&) { return true; });
  EXPECT_EQ(hash_of(all), hash_of(*open()));
}

TEST_P(PassedOn, APartOfThePointsMakesTheMeshOfThatPart) {
  const auto header = open()->header();
  ASSERT_TRUE(header.extent);
  Extent part = *header.extent;
  part.high[0] = (part.low[0] + part.high[0]) / 2;
  const auto kept =
      open_points({input_}, {.dimension = GetParam().dimension, .bounds = part}, context_);
  Filter filter(open(), [&](const Point<3>& p) { return p[0] <= part.high[0]; });
  EXPECT_EQ(hash_of(filter), hash_of(*kept));
}

TEST_P(PassedOn, PointsAreWrittenAsTheLibraryWritesThem) {
  for (const std::string ending : {".las", ".spp", ".npy", ".xyz"}) {
    Filter all(open(), [](const Point<3>&) { return true; });
    convert(all, *create_points(file("passed" + ending), {}, context_), context_);
    convert(*open(), *create_points(file("direct" + ending), {}, context_), context_);
    const auto read = [&](const std::string& name) {
      return open_points({file(name + ending)}, {.dimension = GetParam().dimension}, context_);
    };
    EXPECT_EQ(all_of(*read("passed")), all_of(*read("direct"))) << ending;
    EXPECT_EQ(hash_of(*read("passed")), hash_of(*read("direct"))) << ending;
  }
}

TEST_P(PassedOn, TheExtentHoldsAllPointsToTheLastBit) {
  const auto points = open();
  const PointsHeader header = points->header();
  ASSERT_TRUE(header.extent);
  for (const Point<3>& point : all_of(*points)) {
    for (int axis = 0; axis < 3; ++axis) {
      ASSERT_GE(point[axis], header.extent->low[axis]);
      ASSERT_LE(point[axis], header.extent->high[axis]);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Families, PassedOn,
                         ::testing::Values(Given{"terrain"}, Given{"lattice"}, Given{"duplicates"},
                                           Given{"lattice", 3}, Given{"uniform", 3}));
INSTANTIATE_TEST_SUITE_P(Samples, PassedOn,
                         ::testing::Values(Given{"hexbin-crop.las"}, Given{"sample_nc.las"},
                                           Given{"certainty3d.las"}, Given{"mvk-thin.las", 3}));

class PassedOnWrongly : public CallTest {};

TEST_F(PassedOnWrongly, WhatIsNotOnTheLatticeThatIsToldIsRefused) {
  const Context context(options());
  const PointsHeader header = {.lattice = Lattice{{0.5, 0.5, 0.5}, {10, 0, 0}}};
  const auto error_of = [&](std::vector<Point<3>> points, const PointsHeader& told) {
    OwnPoints source(std::move(points), told);
    MeshInMemory mesh;
    try {
      triangulate(source, mesh, {}, context);
    } catch (const Error& error) {
      return std::string(error.what());
    }
    return std::string("no error");
  };
  EXPECT_EQ(error_of({{10, 0, 0}, {12.5, 0, 1}, {10, 3, 0.5}}, header), "no error");
  EXPECT_THAT(error_of({{10, 0, 0}, {12.3, 0, 1}, {10, 3, 0.5}}, header),
              HasSubstr("x of point 1 is 12.3, which is not on the lattice"));
  EXPECT_THAT(error_of({{10, 0, 0.2}, {12, 0, 1}, {10, 3, 0.5}}, header),
              HasSubstr("z of point 0 is 0.2"));
  PointsHeader without_z = header;
  without_z.lattice = Lattice{{0.5, 0.5, 1}, {10, 0, 0}, false};
  EXPECT_EQ(error_of({{10, 0, 0.2}, {12, 0, 1}, {10, 3, 0.5}}, without_z), "no error");
  without_z.lattice->scale[2] = 0.5;
  EXPECT_THAT(error_of({{10, 0, 0}}, without_z), HasSubstr("a lattice without z"));
  EXPECT_THAT(error_of({{10, 0, 0}}, {.lattice = Lattice{{0, 1, 1}, {0, 0, 0}}}),
              HasSubstr("no lattice has the scale 0"));
}

TEST_F(PassedOnWrongly, StepsThatAreNotTheCoordinatesAreRefused) {
  const Context context(options());
  const MeshHeader header = {.lattice = Lattice{{0.5, 0.5, 0.5}, {0, 0, 0}}};
  const auto error_of = [&](const MeshBlock& block) {
    const auto sink = create_mesh(file("mesh.ply"), {}, context);
    sink->begin(header);
    try {
      sink->write(block);
    } catch (const Error& error) {
      return std::string(error.what());
    }
    return std::string("no error");
  };
  MeshBlock block{.vertices = {{0, 0, 0.2}, {1, 0, 0.5}, {0, 1, 1}},
                  .corners = {0, 1, 2},
                  .finalized = {0, 1, 2}};
  EXPECT_EQ(error_of(block), "no error") << "heights may lie between the steps";
  block.on_lattice = {{0, 0, 0.4}, {2, 0, 1}, {0, 2, 2}};
  EXPECT_EQ(error_of(block), "no error");
  block.on_lattice[1] = {3, 0, 1};
  EXPECT_THAT(error_of(block), HasSubstr("x of vertex 1 is 1, but 3 steps of the lattice"));
  block.on_lattice.pop_back();
  EXPECT_THAT(error_of(block), HasSubstr("a block has 3 vertices, but 2 of them on the lattice"));
  block.on_lattice.clear();
  block.vertices[2] = {0.3, 1, 1};
  EXPECT_THAT(error_of(block), HasSubstr("x of vertex 2 is 0.3"));
}

}  // namespace
}  // namespace spillway::test
