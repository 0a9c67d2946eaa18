// The door for programs where points and meshes stream: <spillway/triangulate.h>.

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <spillway/delaunay.h>
#include <spillway/generate.h>
#include <spillway/triangulate.h>

#include <atomic>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <limits>
#include <random>
#include <set>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include "tests/stream/kept_trace.h"
#include "tests/stream/library/error_code.h"

namespace spillway {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

std::vector<Point<3>> random_points(std::size_t count, std::uint64_t seed = 1) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> coordinate(0, 100);
  std::vector<Point<3>> points(count);
  for (auto& point : points) point = {coordinate(random), coordinate(random), coordinate(random)};
  return points;
}

/// Gives points in blocks of `step`, and fails before the block of number `fails_at`.
class Blocks : public PointSource {
 public:
  Blocks(std::vector<Point<3>> points, std::size_t step, std::size_t fails_at = ~std::size_t{0})
      : points_(std::move(points)), step_(step), fails_at_(fails_at) {}

  [[nodiscard]] PointsHeader header() const override { return {}; }
  bool read(std::vector<Point<3>>& points) override {
    if (block_++ == fails_at_) throw std::runtime_error("the sensor is off");
    const std::size_t end = std::min(points_.size(), next_ + step_);
    points.assign(points_.begin() + static_cast<std::ptrdiff_t>(next_),
                  points_.begin() + static_cast<std::ptrdiff_t>(end));
    next_ = end;
    return !points.empty();
  }

 private:
  std::vector<Point<3>> points_;
  std::size_t step_;
  std::size_t fails_at_;
  std::size_t block_ = 0;
  std::size_t next_ = 0;
};

/// Few points, and a header that claims very many.
class Claims : public Blocks {
 public:
  Claims(std::vector<Point<3>> points, std::uint64_t count)
      : Blocks(std::move(points), 1000), count_(count) {}
  [[nodiscard]] PointsHeader header() const override {
    return {.count = count_, .extent = Extent{{0, 0, 0}, {100, 100, 100}}};
  }

 private:
  std::uint64_t count_;
};

class FailingSink : public MeshSink {
 public:
  void write(const MeshBlock& /*block*/) override { throw std::runtime_error("the line is cut"); }
};

class Streams : public ::testing::Test {
 protected:
  Streams() {
    std::string name = ::testing::TempDir() + "spillway-test-library-XXXXXX";
    if (::mkdtemp(name.data()) != nullptr) folder_ = name;
  }
  ~Streams() override { fs::remove_all(folder_); }

  [[nodiscard]] ContextOptions options(const char* memory = "64M", unsigned threads = 2) const {
    ContextOptions options;
    options.memory = memory;
    options.threads = threads;
    options.scratch_folder = folder_;
    return options;
  }

  std::string folder_;
};

TEST_F(Streams, GiveTheMeshThatIsMadeInMemory) {
  const auto points = random_points(20'000);
  for (const int dimension : {2, 3}) {
    const Context context(options(dimension == 2 ? "32M" : "96M"));
    Blocks source(points, 999);
    MeshInMemory mesh;
    TriangulateOptions how;
    how.dimension = dimension;
    how.tile_points = 3000;
    const Report report = triangulate(source, mesh, how, context);
    std::uint64_t hash = 0;
    std::size_t cells = 0;
    if (dimension == 2) {
      std::vector<Point<2>> plane;
      for (const auto& p : points) plane.push_back({p[0], p[1]});
      const Delaunay<2> whole(plane);
      hash = whole.canonical_hash();
      cells = whole.cell_count();
    } else {
      const Delaunay<3> whole(points);
      hash = whole.canonical_hash();
      cells = whole.cell_count();
    }
    EXPECT_EQ(report.mesh.canonical_hash, hash);
    EXPECT_EQ(report.mesh.simplices, cells);
    EXPECT_EQ(mesh.totals(), report.mesh);
    EXPECT_EQ(mesh.corners().size(), cells * static_cast<std::size_t>(dimension + 1));
    EXPECT_EQ(std::set<Point<3>>(mesh.vertices().begin(), mesh.vertices().end()),
              std::set<Point<3>>(points.begin(), points.end()));
    EXPECT_GT(report.tiles, 1U);
    EXPECT_EQ(report.points.read, points.size());
  }
}

TEST_F(Streams, KeepPointsThatNobodyElseKeeps) {
  const Context context(options("32M"));
  MeshInMemory mesh;
  const auto source = points_in_memory(random_points(1000));
  triangulate(*source, mesh, {}, context);
  EXPECT_EQ(mesh.totals().vertices, 1000U);
  const auto plane = points_in_memory(std::vector<Point<2>>{{0, 0}, {1, 0}, {0, 1}});
  EXPECT_EQ(plane->header().coordinates, 2);
  triangulate(*plane, mesh, {}, context);
  EXPECT_EQ(mesh.corners().size(), 3U);
}

TEST_F(Streams, DoNoWorkForPointsThatAHeaderOnlyClaims) {
  const auto points = random_points(20'000);
  const auto hash_of = [&](PointSource& source, std::uint64_t tile_points, int dimension) {
    const Context context(options("96M"));
    MeshInMemory mesh;
    TriangulateOptions how;
    how.dimension = dimension;
    how.tile_points = tile_points;
    return triangulate(source, mesh, how, context).mesh.canonical_hash;
  };
  for (const int dimension : {2, 3}) {
    Blocks honest(points, 999);
    const std::uint64_t hash = hash_of(honest, 0, dimension);
    for (const std::uint64_t claimed : {std::uint64_t{70'300'024'700'928}, ~std::uint64_t{0}}) {
      for (const std::uint64_t tile_points : {0, 3000}) {
        Claims lie(points, claimed);
        EXPECT_EQ(hash_of(lie, tile_points, dimension), hash) << claimed;
      }
    }
  }
}

TEST_F(Streams, UseNoVertexBeforeItComesNorAfterItIsFinalized) {
  const Context context(options("32M"));
  Blocks source(random_points(30'000), 5000);
  std::set<std::uint64_t> live;
  std::uint64_t next = 0;
  const auto sink = mesh_to([&](const MeshBlock& block) {
    EXPECT_EQ(block.first_vertex, next);
    for (std::size_t i = 0; i < block.vertices.size(); ++i) live.insert(next++);
    for (const std::uint64_t corner : block.corners) EXPECT_TRUE(live.contains(corner));
    for (const std::uint64_t vertex : block.finalized) EXPECT_EQ(live.erase(vertex), 1U);
  });
  triangulate(source, *sink, {.tile_points = 2000}, context);
  EXPECT_EQ(next, 30'000U);
  EXPECT_TRUE(live.empty());
}

TEST_F(Streams, BesideEachOtherWithDifferentOptionsGiveTheRightResultEach) {
  const auto points = random_points(60'000);
  std::vector<std::uint64_t> hashes(4);
  std::vector<std::thread> threads;
  for (std::size_t i = 0; i < hashes.size(); ++i) {
    threads.emplace_back([&, i] {
      const Context context(options(i % 2 == 0 ? "32M" : "200M", static_cast<unsigned>(i + 1)));
      Blocks source(points, 1000 * (i + 1));
      MeshInMemory mesh;
      TriangulateOptions how;
      how.kernel = i == 3 ? Kernel::kCgal : Kernel::kSpillway;
      how.tile_points = i == 0 ? 4000 : 0;
      hashes[i] = triangulate(source, mesh, how, context).mesh.canonical_hash;
    });
  }
  for (std::thread& thread : threads) thread.join();
  EXPECT_THAT(hashes, ::testing::Each(hashes.front()));
}

/// Threads of this process.
std::ptrdiff_t thread_count() {
  return std::distance(fs::directory_iterator("/proc/self/task"), fs::directory_iterator());
}

TEST_F(Streams, LeaveNoThreadsWhenTheContextIsGone) {
  const std::ptrdiff_t before = thread_count();
  {
    const Context context(options("64M", 4));
    Blocks source(random_points(20'000), 5000);
    MeshInMemory mesh;
    triangulate(source, mesh, {}, context);
  }
  for (int wait = 0; wait < 200 && thread_count() > before; ++wait) {
    std::this_thread::sleep_for(std::chrono::milliseconds(10));  // what has ended may still be seen
  }
  EXPECT_LE(thread_count(), before);
}

TEST_F(Streams, ThatStopLeaveNothingAndSayInterrupted) {
  for (const std::string phase : {"read", "triangulate", "write"}) {
    std::stop_source stop;
    ContextOptions stopped = options("32M");
    stopped.stop = stop.get_token();
    stopped.progress = [&](const Progress& progress) {
      if (progress.phase == phase) stop.request_stop();
    };
    const Context context(std::move(stopped));
    Blocks source(random_points(100'000), 5000);
    const std::string path = folder_ + "/mesh.ply";
    {
      const auto sink = create_mesh(path, {}, context);
      EXPECT_EQ(code_of([&] { triangulate(source, *sink, {.tile_points = 20'000}, context); }),
                ErrorCode::kInterrupted)
          << phase;
    }
    EXPECT_TRUE(fs::is_empty(folder_)) << phase;
  }
}

TEST_F(Streams, PassOnWhatTheProgramThrows) {
  const Context context(options());
  Blocks source(random_points(5000), 1000, 3);
  MeshInMemory mesh;
  EXPECT_THROW(
      {
        try {
          triangulate(source, mesh, {}, context);
        } catch (const std::runtime_error& error) {
          EXPECT_STREQ(error.what(), "the sensor is off");
          throw;
        }
      },
      std::runtime_error);
  Blocks good(random_points(5000), 1000);
  FailingSink sink;
  EXPECT_THROW(triangulate(good, sink, {}, context), std::runtime_error);
}

TEST_F(Streams, RefuseWhatCannotBe) {
  const Context context(options());
  MeshInMemory mesh;
  const auto run = [&](std::vector<Point<3>> points, const TriangulateOptions& how) {
    Blocks source(std::move(points), 100);
    return code_of([&] { triangulate(source, mesh, how, context); });
  };
  const auto points = random_points(1000);
  EXPECT_EQ(run(points, {.dimension = 4}), ErrorCode::kInvalidArgument);
  EXPECT_EQ(run(points, {.max_edge = 0.0}), ErrorCode::kInvalidArgument);
  EXPECT_EQ(run(points, {.children = 1}), ErrorCode::kInvalidArgument);
  EXPECT_EQ(run(points, {.heights = static_cast<Heights>(4)}), ErrorCode::kInvalidArgument);
  EXPECT_EQ(run(points, {.division = static_cast<Division>(-1)}), ErrorCode::kInvalidArgument);
  EXPECT_EQ(run(points, {.kernel = static_cast<Kernel>(2)}), ErrorCode::kInvalidArgument);
  EXPECT_EQ(run(points, {.max_edge = 1e-9}), ErrorCode::kDegenerateInput);
  EXPECT_EQ(run({}, {}), ErrorCode::kDegenerateInput);
  EXPECT_EQ(run({{0, 0, 0}, {1, 1, 0}, {2, 2, 5}}, {}), ErrorCode::kDegenerateInput);
  EXPECT_EQ(run({{0, 0, 0}, {1, std::numeric_limits<double>::infinity(), 0}}, {}),
            ErrorCode::kInvalidArgument);
  EXPECT_EQ(code_of([&] { Context({.threads = 5000}); }), ErrorCode::kInvalidArgument);
  const std::vector<Point<2>> flat{{0, 0}, {1, 0}, {0, 1}, {1, 1}};
  const auto plane = points_in_memory(flat);
  EXPECT_EQ(code_of([&] { triangulate(*plane, mesh, {.dimension = 3}, context); }),
            ErrorCode::kDegenerateInput);
}

TEST_F(Streams, WriteBlocksOfAProgramToFiles) {
  const Context context(options());
  const std::string path = folder_ + "/square.sma";
  const auto sink = create_mesh(path, {}, context);
  sink->begin({});
  sink->write({.first_vertex = 0,
               .vertices = {{0, 0, 1}, {1, 0, 2}, {0, 1, 3}},
               .corners = {0, 1, 2},
               .finalized = {0}});
  sink->write(
      {.first_vertex = 3, .vertices = {{1, 1, 4}}, .corners = {1, 3, 2}, .finalized = {1, 2, 3}});
  MeshTotals totals;
  totals.vertices = 4;
  totals.simplices = 2;
  sink->finish(totals);
  EXPECT_TRUE(fs::exists(path));
  const auto other = create_mesh(folder_ + "/other.spm", {}, context);
  EXPECT_EQ(code_of([&] { other->write({}); }), ErrorCode::kInvalidArgument) << "not begun";
  EXPECT_EQ(code_of([&] { sink->finish({}); }), ErrorCode::kInvalidArgument) << "finished";
  other->begin({});
  EXPECT_EQ(code_of([&] { other->write({.corners = {0, 1, 2}}); }), ErrorCode::kInvalidArgument);
}

/// Files of a survey, of which the header of one tells half of its box.
class FalseBoxes : public Streams {
 protected:
  FalseBoxes() {
    const Context context(options());
    generate_grid({.family = "terrain", .count = 40'000}, folder_ + "/t_#.las",
                  {.columns = 7, .rows = 7}, context);
    const std::string path = folder_ + "/t_04_04.las";
    const Extent box = *open_points({path}, {}, context)->header().extent;
    const double most = (box.low[0] + box.high[0]) / 2;
    constexpr std::streamoff kMostX = 179;  // in a LAS header
    std::fstream file(path, std::ios::in | std::ios::out | std::ios::binary);
    file.seekp(kMostX).write(reinterpret_cast<const char*>(&most), sizeof most);
  }

  [[nodiscard]] std::string files() const { return folder_ + "/t_*.las"; }
};

TEST_F(FalseBoxes, AreAnErrorForAProgramThatHasGotBlocks) {
  const Context context(options());
  const auto source = open_points({files()}, {}, context);
  MeshInMemory mesh;
  try {
    triangulate(*source, mesh, {.tile_points = 2000}, context);
    FAIL() << "no error";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::kBadInput);
    EXPECT_EQ(error.facts().remedy, Remedy::kDistrustHeaders);
    EXPECT_THAT(error.what(), HasSubstr("t_04_04.las: point "));
  }
  const auto again = open_points({files()}, {}, context);
  EXPECT_EQ(
      triangulate(*again, mesh, {.tile_points = 2000, .trust_headers = false}, context).mesh.points,
      40'000U);
}

TEST_F(FalseBoxes, LetARunToAFileBeginAgainAndTellTheProgram) {
  std::atomic<int> warnings = 0;
  ContextOptions telling = options();
  telling.warning = [&](std::string_view) { ++warnings; };
  const Context context(telling);
  TriangulateOptions how{.tile_points = 2000};
  const auto trace = std::make_shared<test::KeptTrace>();
  how.trace = trace;
  const auto source = open_points({files()}, {}, context);
  const Report report =
      triangulate(*source, *create_mesh(folder_ + "/again.spm", {}, context), how, context);
  EXPECT_EQ(warnings, 1);
  EXPECT_EQ(trace->begun_again, 1);
  EXPECT_EQ(
      static_cast<std::uint64_t>(std::ranges::count(trace->nodes, 0U, &stream::TaskNode::level)),
      report.tiles);
  EXPECT_FALSE(trace->sums.tasks.empty());
  EXPECT_EQ(report.points.read, 40'000U);
  const auto late = open_points({files()}, {}, context);
  how = {.tile_points = 2000, .trust_headers = false};
  EXPECT_EQ(triangulate(*late, *create_mesh(folder_ + "/late.spm", {}, context), how, context).mesh,
            report.mesh);
}

TEST_F(Streams, ReadFilesWithFilters) {
  std::ofstream text(folder_ + "/a.txt");
  for (int i = 0; i < 1000; ++i) text << i % 40 << ' ' << i / 40 << ' ' << i << '\n';
  text.close();
  const Context context(options());
  const auto source =
      open_points({folder_}, {.every = 2, .thin = Thin{4, ThinChoice::kHighest}}, context);
  EXPECT_EQ(source->header().coordinates, 3);
  MeshInMemory mesh;
  const Report report = triangulate(*source, mesh, {}, context);
  EXPECT_EQ(report.points.read, 1000U);
  EXPECT_EQ(report.points.skipped, 500U);
  EXPECT_GT(report.points.thinned, 0U);
  EXPECT_EQ(code_of([&] { open_points({folder_ + "/none.txt"}, {}, context); }),
            ErrorCode::kInputOutput);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const Thin no_choice{4, static_cast<ThinChoice>(9)};
  for (const PointOptions& wrong :
       {PointOptions{.classes = {300}}, PointOptions{.resolution = nan},
        PointOptions{.resolution = -1}, PointOptions{.text = {.columns = {1}}},
        PointOptions{.text = {.columns = {0, 1}}}, PointOptions{.text = {.columns = {2, 2}}},
        PointOptions{.thin = no_choice}}) {
    EXPECT_EQ(code_of([&] { open_points({folder_}, wrong, context); }),
              ErrorCode::kInvalidArgument);
  }
  const auto again = open_points({folder_}, {}, context);
  EXPECT_EQ(code_of([&] { triangulate(*again, mesh, {.dimension = 3}, context); }),
            ErrorCode::kInvalidArgument);
}

}  // namespace
}  // namespace spillway
