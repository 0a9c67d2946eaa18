// A program's own products: states of any type, by threads, from points and meshes, in both
// dimensions.

#include <spillway/convert.h>
#include <spillway/product.h>
#include <spillway/triangulate.h>

#include <cmath>
#include <cstring>
#include <map>
#include <random>

#include "tests/stream/library/call_test.h"

namespace spillway::test {
namespace {

/// The volume of tetrahedra, and of triangles the area.
struct Measure {
  double size = 0;
  std::uint64_t simplices = 0;

  void add(const SimplexBlock& block) {
    const std::size_t count = static_cast<std::size_t>(block.dimension) + 1;
    for (std::size_t c = 0; c < block.corners.size(); c += count) {
      const auto side = [&](std::size_t corner, int axis) {
        return block.vertices[block.corners[c + corner]][axis] -
               block.vertices[block.corners[c]][axis];
      };
      const double base = side(1, 0) * side(2, 1) - side(1, 1) * side(2, 0);
      if (block.dimension == 2) {
        size += base / 2;
      } else {
        const double x = side(1, 1) * side(2, 2) - side(1, 2) * side(2, 1);
        const double y = side(1, 2) * side(2, 0) - side(1, 0) * side(2, 2);
        size += std::abs(x * side(3, 0) + y * side(3, 1) + base * side(3, 2)) / 6;
      }
      ++simplices;
    }
  }
  void combine(const Measure& other) {
    size += other.size;
    simplices += other.simplices;
  }
};

/// How many vertices each whole number of x has: a state that grows, and knows its bytes.
struct Columns {
  std::map<int, std::uint64_t> counts;

  Columns() = default;
  explicit Columns(std::span<const std::byte> bytes) {
    for (std::size_t at = 0; at < bytes.size(); at += 16) {
      std::int64_t column = 0;
      std::memcpy(&column, bytes.data() + at, 8);
      std::memcpy(&counts[static_cast<int>(column)], bytes.data() + at + 8, 8);
    }
  }
  [[nodiscard]] std::vector<std::byte> bytes() const {
    std::vector<std::byte> bytes(16 * counts.size());
    std::size_t at = 0;
    for (const auto& [column, count] : counts) {
      const std::int64_t number = column;
      std::memcpy(bytes.data() + at, &number, 8);
      std::memcpy(bytes.data() + at + 8, &count, 8);
      at += 16;
    }
    return bytes;
  }
  void add(const SimplexBlock& /*block*/) {}
  void add_vertices(std::span<const Point<3>> vertices) {
    for (const Point<3>& vertex : vertices) ++counts[static_cast<int>(std::floor(vertex[0]))];
  }
  void combine(const Columns& other) {
    for (const auto& [column, count] : other.counts) counts[column] += count;
  }
};

std::vector<Point<3>> box_of_points(std::size_t count) {
  std::vector<Point<3>> points;
  for (int corner = 0; corner < 8; ++corner) {
    points.push_back({10.0 * (corner & 1), 5.0 * (corner >> 1 & 1), 2.0 * (corner >> 2)});
  }
  std::mt19937 random(4);
  const auto coordinate = [&random](double size) {
    return size * std::uniform_real_distribution<double>(0, 1)(random);
  };
  while (points.size() < count) {
    points.push_back({coordinate(10), coordinate(5), coordinate(2)});
  }
  return points;
}

using OwnProducts = CallTest;

TEST_F(OwnProducts, MeasureTheWholeHullInBothDimensions) {
  const auto points = box_of_points(40'000);
  for (const int dimension : {2, 3}) {
    const Context context(options());
    Product<Measure> product(context);
    const Report report =
        triangulate(*points_in_memory(points), product.sink(),
                    {.dimension = dimension, .tile_points = 4000, .leaf_points = 500}, context);
    EXPECT_NEAR(product.result().size, dimension == 2 ? 50 : 100, 1e-9);
    EXPECT_EQ(product.result().simplices, report.mesh.simplices);
  }
}

TEST_F(OwnProducts, TakeEachVertexOnceFromPointsAndMeshes) {
  const auto points = box_of_points(30'000);
  const Context context(options());
  Product<Columns> from_points(context);
  MeshInMemory mesh;
  triangulate(*points_in_memory(points), from_points.sink(), {.tile_points = 2000}, context);
  const auto file = create_mesh(this->file("mesh.spm"), {}, context);
  triangulate(*points_in_memory(points), *file, {.tile_points = 2000}, context);
  Product<Columns> from_mesh(context);
  const Report report =
      convert(*open_mesh(this->file("mesh.spm"), {}, context), from_mesh.sink(), context);
  EXPECT_EQ(from_mesh.result().counts, from_points.result().counts);
  std::uint64_t sum = 0;
  for (const auto& [column, count] : from_points.result().counts) sum += count;
  EXPECT_EQ(sum, report.mesh.vertices);
}

TEST_F(OwnProducts, AreFedByAProgramThatHasTheBlocks) {
  const std::vector<Point<3>> points = {{0, 0, 0}, {4, 0, 0}, {0, 4, 0}, {4, 4, 0}, {2, 1, 0}};
  const Context context(options());
  Product<Measure> product(context);
  product.sink().begin({});
  const auto passing = mesh_to([&product](const MeshBlock& block) { product.sink().write(block); });
  const Report report = triangulate(*points_in_memory(points), *passing, {}, context);
  product.sink().finish(report.mesh);
  EXPECT_NEAR(product.result().size, 16, 1e-12);
}

TEST_F(OwnProducts, AreOfOneMesh) {
  const auto points = box_of_points(100);
  const Context context(options());
  Product<Measure> product(context);
  triangulate(*points_in_memory(points), product.sink(), {}, context);
  EXPECT_EQ(code_of([&] { triangulate(*points_in_memory(points), product.sink(), {}, context); }),
            ErrorCode::kInvalidArgument);
  EXPECT_EQ(code_of([&] { (void)create_product(nullptr, context); }), ErrorCode::kInvalidArgument);
}

TEST_F(OwnProducts, BeginWithWhatTheyAreGiven) {
  struct Scaled {
    double factor = 1;
    double sum = 0;
    void add(const SimplexBlock& block) {
      sum += factor * static_cast<double>(block.corners.size());
    }
    void combine(const Scaled& other) { sum += other.sum; }
  };
  const auto points = box_of_points(5'000);
  const Context context(options());
  Product<Scaled> product(context, {.factor = 0.5});
  const Report report =
      triangulate(*points_in_memory(points), product.sink(), {.leaf_points = 200}, context);
  EXPECT_EQ(product.result().sum, 1.5 * static_cast<double>(report.mesh.simplices));
  EXPECT_EQ(product.result().factor, 0.5);
}

}  // namespace
}  // namespace spillway::test
