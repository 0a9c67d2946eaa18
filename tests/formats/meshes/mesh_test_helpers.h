#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <ostream>
#include <string>
#include <vector>

#include "formats/inputs/open_mesh.h"
#include "formats/meshes/common/mesh_writer.h"
#include "formats/meshes/create_mesh.h"
#include "src/error.h"
#include "tests/faulty_file_system.h"
#include "tests/formats/point_test_helpers.h"

namespace spillway::test {

/// For the parameters of tests.
inline void PrintTo(const MeshFormat* format, std::ostream* out) { *out << format->name; }

}  // namespace spillway::test

namespace spillway::test {

/// A few simplices of doubles that need 17 digits, at offsets as large as UTM's, signed zeros and
/// subnormals among them.
inline Mesh awkward_mesh(int dimension) {
  Mesh mesh;
  mesh.header.dimension = dimension;
  mesh.vertices = {{500000.123456789, 4649776.22482, -1.0 / 3.0},
                   {500000.12345678906, 5e-324, 1e300},
                   {-0.0, 0.1 + 0.2, 2.2250738585072014e-308},
                   {std::nextafter(1.0, 2.0), 1.7976931348623157e308, 12345678901234568.0},
                   {1, 2, 3}};
  mesh.corners = dimension == 2 ? std::vector<std::uint64_t>{0, 1, 2, 3, 2, 1, 4, 0, 3}
                                : std::vector<std::uint64_t>{0, 1, 2, 3, 4, 3, 2, 1};
  mesh.header.vertices = mesh.vertices.size();
  mesh.header.simplices = mesh.corners.size() / mesh.corners_per_simplex();
  return mesh;
}

/// Gives every vertex an index, one of them beyond 32 bits.
inline void add_input_index(Mesh& mesh) {
  mesh.header.has_input_index = true;
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) mesh.input_index.push_back(7 * i + 1);
  if (!mesh.input_index.empty()) mesh.input_index.back() = (std::uint64_t{1} << 53) - 1;
}

inline IntegerLattice awkward_lattice() {
  return {{0.01, 0.010000000000000002, 0.001}, {500000.5, -4649776.123456789, 1e-7}};
}

/// Writes a mesh in blocks of `block` vertices and simplices.
inline void write_mesh(MeshWriter& writer, const Mesh& mesh, std::size_t block = 3) {
  const std::span<const WorldPoint> vertices(mesh.vertices);
  const std::span<const std::uint64_t> index(mesh.input_index);
  const std::span<const std::byte> records(mesh.attributes);
  const std::size_t record = mesh.header.attributes.record_size();
  do {
    for (std::size_t at = 0; at < vertices.size(); at += block) {
      const std::size_t count = std::min(block, vertices.size() - at);
      writer.write_vertices(vertices.subspan(at, count),
                            index.empty() ? index : index.subspan(at, count),
                            records.subspan(at * record, count * record));
    }
  } while (writer.begin_vertices_again());
  const std::span<const std::uint64_t> corners(mesh.corners);
  const std::size_t step = block * mesh.corners_per_simplex();
  for (std::size_t at = 0; at < corners.size(); at += step) {
    const std::size_t count = std::min(step, corners.size() - at);
    writer.write_simplices(corners.subspan(at, count));
    if (mesh.header.periodic) writer.write_offsets(at, std::span(mesh.offsets).subspan(at, count));
  }
  writer.finish();
}

/// Writes a mesh to a file.
inline void write_mesh(FileSystem& files, const std::string& path, const MeshFormat& format,
                       const Mesh& mesh, std::size_t block = 3) {
  write_mesh(*open_mesh_writer(files, path, format, mesh.header), mesh, block);
}

/// The bytes of a mesh in a format of one file.
inline std::string mesh_bytes(const MeshFormat& format, const Mesh& mesh) {
  FaultyFileSystem files;
  write_mesh(files, "mesh", format, mesh);
  return files.files.at("mesh");
}

/// Reads bytes as a file of that name.
inline Mesh read_bytes(const std::string& path, const std::string& bytes, bool seekable = true) {
  FaultyFileSystem files;
  files.seekable = seekable;
  files.files[path] = bytes;
  return read_mesh(files, path);
}

/// The message that reading these bytes ends with; it names the file. A pipe, whose size is not
/// known, must end with an Failure, too.
inline std::string error_of_bytes(const std::string& path, const std::string& bytes) {
  error_of([&] { read_bytes(path, bytes, false); });
  std::string message = error_of([&] { read_bytes(path, bytes); });
  EXPECT_THAT(message, ::testing::HasSubstr(path));
  return message;
}

/// Replaces the first occurrence of `from`, which must be there.
inline std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return at == std::string::npos ? text : text.replace(at, from.size(), to);
}

/// Expects equality in every bit, the sign of zero included.
inline void expect_equal(const Mesh& a, const Mesh& b) {
  EXPECT_EQ(a.header.dimension, b.header.dimension);
  EXPECT_EQ(a.header.vertices, b.header.vertices);
  EXPECT_EQ(a.header.simplices, b.header.simplices);
  EXPECT_EQ(a.header.has_input_index, b.header.has_input_index);
  EXPECT_EQ(a.header.lattice, b.header.lattice);
  EXPECT_EQ(a.header.crs, b.header.crs);
  ASSERT_EQ(a.vertices, b.vertices);
  for (std::size_t i = 0; i < a.vertices.size(); ++i) {
    for (int axis = 0; axis < 3; ++axis) {
      EXPECT_EQ(std::signbit(a.vertices[i][axis]), std::signbit(b.vertices[i][axis]));
    }
  }
  EXPECT_EQ(a.corners, b.corners);
  EXPECT_EQ(a.input_index, b.input_index);
  EXPECT_TRUE(a.header.attributes == b.header.attributes);
  EXPECT_TRUE(a.attributes == b.attributes);
}

}  // namespace spillway::test
