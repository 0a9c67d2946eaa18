// What the library's calls do over ranks: products whose states know their bytes, and what is
// refused.

#include "stream/ranks/rank_executor.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <spillway/convert.h>
#include <spillway/generate.h>
#include <spillway/product.h>
#include <spillway/triangulate.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <map>
#include <string>

#include "src/runtime/packing.h"
#include "tests/distributed/world.h"
#include "tests/stream/library/error_code.h"

namespace spillway::test {
namespace {

/// How many vertices each hundredth of x has.
struct Columns {
  std::map<std::int64_t, std::uint64_t> counts;

  Columns() = default;
  explicit Columns(std::span<const std::byte> bytes) {
    for (Unpacker columns(bytes); !columns.empty();) {
      const auto column = columns.take<std::int64_t>();
      counts[column] = columns.take<std::uint64_t>();
    }
  }
  [[nodiscard]] std::vector<std::byte> bytes() const {
    Packer columns;
    for (const auto& [column, count] : counts) {
      columns.put(column);
      columns.put(count);
    }
    return columns.take();
  }
  void add(const SimplexBlock& /*block*/) {}
  void add_vertices(std::span<const Point<3>> vertices) {
    for (const Point<3>& vertex : vertices) ++counts[std::llround(vertex[0] * 100)];
  }
  void combine(const Columns& other) {
    for (const auto& [column, count] : other.counts) counts[column] += count;
  }
};

/// Points in a file that all ranks see, and the context of their common runs.
class RunsOverRanks : public ::testing::Test {
 protected:
  RunsOverRanks() {
    std::string name = ::testing::TempDir() + "ranks" + std::to_string(::getpid()) + ".npy";
    std::vector<std::byte> bytes(name.size());
    std::copy_n(reinterpret_cast<const std::byte*>(name.data()), name.size(), bytes.begin());
    world().broadcast(bytes, 0);
    path_.assign(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    if (world().rank() == 0) {
      const auto points = generate_points({.count = 20'000, .dimension = 3});
      convert(*points, *create_points(path_, {}, Context()), Context());
    }
    world().barrier();
  }
  ~RunsOverRanks() override {
    world().barrier();
    if (world().rank() == 0) std::filesystem::remove(path_);
  }

  std::string path_;
  Context context_{{.memory = "64M", .threads = 1, .executor = make_rank_executor(world())}};
};

TEST_F(RunsOverRanks, CombineStatesThatKnowTheirBytes) {
  Product<Columns> shared(context_);
  triangulate(*open_points({path_}, {}, context_), shared.sink(), {}, context_);
  if (world().rank() != 0) return;
  const Context alone({.memory = "64M"});
  Product<Columns> product(alone);
  triangulate(*open_points({path_}, {}, alone), product.sink(), {}, alone);
  EXPECT_EQ(shared.result().counts, product.result().counts);
  EXPECT_FALSE(product.result().counts.empty());
}

TEST_F(RunsOverRanks, RefuseSinksThatTakeTheMeshOfOneProcess) {
  MeshInMemory sink;
  EXPECT_EQ(code_of([&] { triangulate(*open_points({path_}, {}, context_), sink, {}, context_); }),
            ErrorCode::kInvalidArgument);
}

TEST_F(RunsOverRanks, RefusePointsOfAProgram) {
  Product<Columns> product(context_);
  const auto points = points_in_memory(std::vector<Point<3>>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}});
  EXPECT_EQ(code_of([&] { triangulate(*points, product.sink(), {}, context_); }),
            ErrorCode::kInvalidArgument);
}

}  // namespace
}  // namespace spillway::test
