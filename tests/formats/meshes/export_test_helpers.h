#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <random>
#include <string>
#include <vector>

#include "formats/meshes/mesh_formats.h"
#include "tests/formats/meshes/stream_test_helpers.h"

namespace spillway::test {

/// A grid of triangles over one square kilometre of UTM, every vertex used.
inline StreamedMesh kilometre(const std::string& crs) {
  constexpr std::size_t kSide = 20;
  StreamedMesh mesh;
  mesh.header.crs = crs;
  std::mt19937_64 random(17);
  std::uniform_real_distribution<double> jitter(0, 10);
  MeshStreamBlock& block = mesh.blocks.emplace_back();
  for (std::size_t i = 0; i < kSide * kSide; ++i) {
    block.vertices.push_back(
        {547000.123456789 + 1000.0 / kSide * double(i % kSide) + jitter(random),
         5280000.987654321 + 1000.0 / kSide * double(i / kSide) + jitter(random),
         431.1 + jitter(random)});
    block.finalized.push_back(i);
  }
  for (std::uint32_t row = 0; row + 1 < kSide; ++row) {
    for (std::uint32_t column = 0; column + 1 < kSide; ++column) {
      const std::uint32_t corner = row * kSide + column;
      for (const std::uint32_t c :
           {corner, corner + 1, corner + std::uint32_t{kSide}, corner + std::uint32_t{kSide} + 1,
            corner + std::uint32_t{kSide}, corner + 1}) {
        block.corners.push_back(c);
      }
    }
  }
  mesh.totals.vertices = block.vertices.size();
  mesh.totals.simplices = block.corners.size() / 3;
  return mesh;
}

inline void write_stream(FileSystem& files, const std::string& path, const StreamedMesh& mesh) {
  const auto scratch = make_scratch_folder("", std::nullopt);
  const auto writer =
      open_mesh_stream_writer(files, path, mesh_format(path, ""), mesh.header, *scratch);
  write_blocks(*writer, mesh);
  EXPECT_GT(writer->bytes_written(), 0U);
}

/// The bytes of a file of that name.
inline std::string bytes_as(const std::string& path, const StreamedMesh& mesh) {
  FaultyFileSystem files;
  write_stream(files, path, mesh);
  EXPECT_EQ(files.files.size(), 1U);
  return files.files.at(path);
}

using Triangle = std::array<WorldPoint, 3>;

inline Triangle turned(Triangle triangle) {
  std::rotate(triangle.begin(), std::min_element(triangle.begin(), triangle.end()), triangle.end());
  return triangle;
}

/// The triangles of a stream in output coordinates, in order, each turned to its smallest corner.
inline std::vector<Triangle> triangles_of(const StreamedMesh& mesh) {
  std::vector<WorldPoint> vertices;
  std::vector<Triangle> result;
  for (const MeshStreamBlock& block : mesh.blocks) {
    const StreamNumbers numbers(vertices.size(), block);
    for (const LatticePoint& vertex : block.vertices) {
      vertices.push_back(in_world(mesh.header.lattice, vertex));
    }
    for (std::size_t i = 0; i < block.corners.size(); i += 3) {
      Triangle triangle;
      for (std::size_t k = 0; k < 3; ++k) {
        triangle[k] = vertices.at(numbers[block.corners[i + k]]);
      }
      result.push_back(turned(triangle));
    }
  }
  return result;
}

inline std::vector<Triangle> triangles_of(const Mesh& mesh) {
  std::vector<Triangle> result;
  for (std::size_t i = 0; i < mesh.corners.size(); i += 3) {
    result.push_back(
        turned({mesh.vertices.at(mesh.corners[i]), mesh.vertices.at(mesh.corners[i + 1]),
                mesh.vertices.at(mesh.corners[i + 2])}));
  }
  return result;
}

inline std::vector<Triangle> sorted(std::vector<Triangle> triangles) {
  std::sort(triangles.begin(), triangles.end());
  return triangles;
}

/// Expects the same triangles in the same order, each coordinate within `tolerance`.
inline void expect_near(const std::vector<Triangle>& a, const std::vector<Triangle>& b,
                        double tolerance) {
  ASSERT_EQ(a.size(), b.size());
  double worst = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    for (std::size_t k = 0; k < 3; ++k) {
      for (int axis = 0; axis < 3; ++axis) {
        worst = std::max(worst, std::abs(a[i][k][axis] - b[i][k][axis]));
      }
    }
  }
  EXPECT_LE(worst, tolerance);
}

}  // namespace spillway::test
