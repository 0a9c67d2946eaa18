// Runs with a resume_folder, as a program sees them; tests/stream/checkpoint kills them.

#include <gmock/gmock.h>
#include <spillway/dem.h>
#include <spillway/generate.h>
#include <spillway/triangulate.h>

#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "src/error.h"

namespace spillway {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

class ResumableRun : public ::testing::Test {
 protected:
  ResumableRun() {
    std::string name = ::testing::TempDir() + "resumable_run_test_XXXXXX";
    folder_ = ::mkdtemp(name.data());
    std::ofstream points(path("points.txt"));
    for (int i = 0; i < 2000; ++i) points << i % 47 << ' ' << i * 37 % 101 << ' ' << i << '\n';
  }
  ~ResumableRun() override { fs::remove_all(folder_); }

  [[nodiscard]] std::string path(const std::string& name) const {
    return (folder_ / name).string();
  }
  [[nodiscard]] TriangulateOptions options() const {
    return {.tile_points = 100, .resume_folder = path("run"), .checkpoint_seconds = 0};
  }
  [[nodiscard]] std::unique_ptr<PointSource> points() const {
    return open_points({path("points.txt")}, {}, context_);
  }
  [[nodiscard]] std::string bytes_of(const std::string& name) const {
    std::ifstream file(path(name), std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
  }
  /// What triangulate() throws.
  [[nodiscard]] std::string error_of(PointSource& source, MeshSink& sink,
                                     const TriangulateOptions& how) const {
    try {
      triangulate(source, sink, how, context_);
    } catch (const Error& error) {
      return error.what();
    }
    return "";
  }

  fs::path folder_;
  Context context_{{.memory = "64M", .threads = 2}};
};

TEST_F(ResumableRun, MakesTheSameMeshAndRemovesItsFolder) {
  const auto usual = points();
  triangulate(*usual, *create_mesh(path("usual.spm"), {}, context_), {.tile_points = 100},
              context_);
  const auto source = points();
  const Report report =
      triangulate(*source, *create_mesh(path("mesh.spm"), {}, context_), options(), context_);
  EXPECT_EQ(report.mesh.points, 2000U);
  EXPECT_EQ(bytes_of("mesh.spm"), bytes_of("usual.spm"));
  EXPECT_FALSE(fs::exists(path("run")));
}

TEST_F(ResumableRun, EndsWhenItsOutputWasComplete) {
  const Context ended({.memory = "64M", .threads = 2, .detail = [](std::string_view text) {
                         if (text.find("checkpoints took") != text.npos) {
                           throw std::runtime_error("the end");
                         }
                       }});
  const auto killed = open_points({path("points.txt")}, {}, ended);
  EXPECT_THROW(triangulate(*killed, *create_mesh(path("mesh.spm"), {}, ended), options(), ended),
               std::runtime_error);
  const std::string bytes = bytes_of("mesh.spm");
  EXPECT_FALSE(bytes.empty());
  const auto source = points();
  const Report report =
      triangulate(*source, *create_mesh(path("mesh.spm"), {}, context_), options(), context_);
  EXPECT_EQ(report.mesh.points, 2000U);
  EXPECT_EQ(bytes_of("mesh.spm"), bytes);
  EXPECT_FALSE(fs::exists(path("run")));
}

TEST_F(ResumableRun, GivesASinkOfTheProgramAllBlocksInTheEnd) {
  std::uint64_t triangles = 0;
  const auto sink = mesh_to([&](const MeshBlock& block) { triangles += block.corners.size() / 3; });
  const auto source = points();
  const Report report = triangulate(*source, *sink, options(), context_);
  EXPECT_EQ(triangles, report.mesh.simplices);
  EXPECT_GT(triangles, 0U);
  EXPECT_FALSE(fs::exists(path("run")));
}

TEST_F(ResumableRun, RefusesPointsOfAProgramAndStandardOutput) {
  const auto in_memory = points_in_memory(std::vector<Point<3>>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}});
  const auto mesh = create_mesh(path("mesh.spm"), {}, context_);
  EXPECT_THAT(error_of(*in_memory, *mesh, options()), HasSubstr("a program's"));
  const auto source = points();
  const auto pipe = create_mesh("-", {.format = "spm"}, context_);
  EXPECT_THAT(error_of(*source, *pipe, options()), HasSubstr("standard output, is not a file"));
  EXPECT_FALSE(fs::exists(path("run")));
}

TEST_F(ResumableRun, GoesOnWithARasterOfTheSamePixelsAlone) {
  DemOptions raster{.resolution = 1};
  const auto run = [&](const std::string& name, const TriangulateOptions& how) {
    const auto source = points();
    return error_of(*source, *create_dem(path(name), raster, context_), how);
  };
  EXPECT_EQ(run("usual.tif", {.tile_points = 100}), "");
  const Context ended({.memory = "64M", .threads = 2, .progress = [](const Progress& progress) {
                         if (progress.phase == "write") throw std::runtime_error("the end");
                       }});
  const auto source = open_points({path("points.txt")}, {}, ended);
  EXPECT_THROW(triangulate(*source, *create_dem(path("dem.tif"), raster, ended), options(), ended),
               std::runtime_error);
  EXPECT_TRUE(fs::exists(path("run/state")));
  raster.resolution = 2;
  EXPECT_THAT(run("dem.tif", options()), HasSubstr("side of a pixel is 2, and was 1"));
  raster.resolution = 1;
  EXPECT_EQ(run("dem.tif", options()), "");
  EXPECT_EQ(bytes_of("dem.tif"), bytes_of("usual.tif"));
  EXPECT_FALSE(fs::exists(path("run")));
}

/// Points that were told of before the checkpoint do not come again, and all others do.
TEST_F(ResumableRun, GoesOnWithThePointsThatAreInPixels) {
  const DemOptions raster{.products = {DemProduct::kCount, DemProduct::kMean, DemProduct::kHeight,
                                       DemProduct::kPercentile},
                          .resolution = 7,
                          .percentiles = {50}};
  const auto run = [&](const std::string& name, const TriangulateOptions& how,
                       const Context& context) {
    const auto source = open_points({path("points.txt")}, {}, context);
    triangulate(*source, *create_dem(path(name), raster, context), how, context);
  };
  run("usual.tif", {.tile_points = 100}, context_);
  for (const std::uint64_t last : {300U, 900U, 1500U}) {
    const Context ended({.memory = "64M", .threads = 2, .progress = [=](const Progress& progress) {
                           if (progress.phase == "triangulate" && progress.done >= last) {
                             throw std::runtime_error("the end");
                           }
                         }});
    EXPECT_THROW(run("dem.tif", options(), ended), std::runtime_error);
    EXPECT_TRUE(fs::exists(path("run/state")));
  }
  run("dem.tif", options(), context_);
  EXPECT_EQ(bytes_of("dem.tif"), bytes_of("usual.tif"));
}

TEST_F(ResumableRun, LeavesTheMeshForWhatFailsButNotForWantOfMemory) {
  const auto folder_after = [&](ErrorCode code, Remedy remedy) {
    const auto sink =
        mesh_to([&](const MeshBlock&) { throw runtime::Failure("no", code, {.remedy = remedy}); });
    const auto source = points();
    EXPECT_EQ(error_of(*source, *sink, options()), "no");
    return fs::exists(path("run"));
  };
  EXPECT_TRUE(folder_after(ErrorCode::kInputOutput, Remedy::kNone));
  EXPECT_FALSE(folder_after(ErrorCode::kOutOfBudget, Remedy::kMemory));
}

TEST_F(ResumableRun, RefusesNegativeSeconds) {
  TriangulateOptions how = options();
  how.checkpoint_seconds = -1;
  const auto source = points();
  const auto mesh = create_mesh(path("mesh.spm"), {}, context_);
  EXPECT_THAT(error_of(*source, *mesh, how), HasSubstr("-1 seconds"));
}

TEST_F(ResumableRun, ThatFailsBeforeACheckpointLeavesNothing) {
  std::ofstream(path("line.txt")) << "0 0 0\n1 1 0\n2 2 0\n";
  const auto source = open_points({path("line.txt")}, {}, context_);
  TriangulateOptions how = options();
  how.checkpoint_seconds = 1000;
  EXPECT_THAT(error_of(*source, *create_mesh(path("mesh.spm"), {}, context_), how),
              HasSubstr("one line"));
  EXPECT_FALSE(fs::exists(path("run")));
  for (const fs::directory_entry& entry : fs::directory_iterator(folder_)) {
    EXPECT_FALSE(entry.path().string().ends_with(".part")) << entry.path();
  }
}

}  // namespace
}  // namespace spillway
