#pragma once

#include <algorithm>
#include <array>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "formats/inputs/open_mesh_stream.h"
#include "formats/meshes/common/mesh_stream.h"
#include "formats/meshes/common/stream_numbers.h"
#include "formats/meshes/mesh_stream_writer.h"
#include "tests/formats/meshes/mesh_test_helpers.h"

namespace spillway::test {

/// A mesh in blocks, and what its stream says of it.
struct StreamedMesh {
  MeshStreamHeader header;
  std::vector<MeshStreamBlock> blocks;
  MeshTotals totals;
};

/// A strip of triangles, or of tetrahedra, over `steps` vertices on a lattice, in blocks of `size`
/// new vertices. Each block imports the last vertices of the one before.
inline StreamedMesh strip(int dimension, std::size_t steps, std::size_t size) {
  StreamedMesh mesh;
  mesh.header.dimension = dimension;
  mesh.header.lattice = IntegerLattice{{0.01, 0.01, 0.01}, {500000, 4100000, -3.25}};
  const std::size_t overlap = dimension;
  std::size_t simplices = 0;
  for (std::size_t begin = 0; begin < steps; begin += size) {
    MeshStreamBlock& block = mesh.blocks.emplace_back();
    const std::size_t end = std::min(begin + size, steps);
    for (std::size_t i = begin; i < end; ++i) {
      const auto t = static_cast<double>(i);
      block.vertices.push_back({t, double((i * 7) % 5), double((i * 3) % 11)});
      if (dimension == 2 && i % 4 == 1) block.vertices.back()[2] += 0.5;
    }
    const std::size_t imported = std::min(begin, overlap);
    for (std::size_t i = begin - imported; i < begin; ++i) block.imported.push_back(i);
    const auto number = [&](std::size_t vertex) {
      return static_cast<std::uint32_t>(
          vertex >= begin ? vertex - begin : end - begin + (vertex - (begin - imported)));
    };
    for (std::size_t i = begin - imported; i + overlap < end; ++i, ++simplices) {
      std::vector<std::uint32_t> corners;
      for (std::size_t k = 0; k <= overlap; ++k) corners.push_back(number(i + k));
      if (i % 2 == 1) std::rotate(corners.begin(), corners.begin() + 1, corners.begin() + 3);
      block.corners.insert(block.corners.end(), corners.begin(), corners.end());
    }
    const std::size_t live = end == steps ? 0 : std::min(end, overlap);
    for (std::size_t i = begin - imported; i + live < end; ++i) {
      block.finalized.push_back(number(i));
    }
  }
  mesh.totals = {steps, simplices, steps, steps + 3, 3, 0x0123456789ABCDEF};
  return mesh;
}

/// Gives every vertex an input index.
inline void add_input_index(StreamedMesh& mesh) {
  mesh.header.has_input_index = true;
  std::uint64_t next = 17;
  for (MeshStreamBlock& block : mesh.blocks) {
    for (std::size_t i = 0; i < block.vertices.size(); ++i) {
      block.input_index.push_back(next = next * 7 % 1000003);
    }
  }
}

/// Takes the lattice away, so that any doubles may come.
inline void leave_lattice(StreamedMesh& mesh) {
  for (MeshStreamBlock& block : mesh.blocks) {
    for (LatticePoint& vertex : block.vertices) {
      vertex = LatticePoint(in_world(mesh.header.lattice, vertex).numbers());
    }
  }
  mesh.header.lattice.reset();
}

inline void write_blocks(MeshStreamWriter& writer, const StreamedMesh& mesh, bool absorb = false) {
  for (MeshStreamBlock block : mesh.blocks) {
    if (absorb) {
      const std::vector<std::uint64_t> imported = std::exchange(block.imported, {});
      writer.absorb(block);
      block.imported = imported;
    }
    writer.write(std::move(block));
  }
  writer.finish(mesh.totals);
}

/// The bytes of the mesh as a stream.
inline std::string stream_bytes(const StreamedMesh& mesh, const MeshFormat& format,
                                bool absorb = false) {
  FaultyFileSystem files;
  files.seekable = false;
  const auto scratch = make_scratch_folder("", std::nullopt);
  const auto writer = open_mesh_stream_writer(files, "a", format, mesh.header, *scratch);
  write_blocks(*writer, mesh, absorb);
  EXPECT_EQ(writer->bytes_written(), files.files.at("a").size());
  EXPECT_EQ(scratch->bytes_written(), 0U);
  return files.files.at("a");
}

/// All blocks of a stream.
inline StreamedMesh read_stream(const std::string& path, const std::string& bytes,
                                const std::string& format = "") {
  FaultyFileSystem files;
  files.seekable = false;
  files.files[path] = bytes;
  const auto reader = open_mesh_stream_reader(files, path, format);
  StreamedMesh mesh;
  mesh.header = reader->header();
  MeshStreamBlock block;
  while (reader->read(block)) mesh.blocks.push_back(block);
  EXPECT_FALSE(reader->read(block));
  mesh.totals = reader->totals();
  return mesh;
}

inline std::string error_of_stream(const std::string& path, const std::string& bytes) {
  return error_of([&] { read_stream(path, bytes); });
}

/// A mesh without blocks: its vertices, its simplices turned and sorted, and after how many
/// simplices at the least each vertex is finalized.
struct FlatMesh {
  std::vector<LatticePoint> vertices;
  std::vector<std::uint64_t> input_index;
  std::vector<std::byte> attributes;
  std::vector<std::vector<std::uint64_t>> simplices;
  std::map<std::uint64_t, std::size_t> finalized;

  bool operator==(const FlatMesh&) const = default;
};

/// The simplex with its smallest corner first and, of those turns, the smallest corner second.
inline std::vector<std::uint64_t> turned(std::vector<std::uint64_t> simplex) {
  const auto first = std::min_element(simplex.begin(), simplex.end()) - simplex.begin();
  if (simplex.size() == 3) {
    std::rotate(simplex.begin(), simplex.begin() + first, simplex.end());
    return simplex;
  }
  if (first == 1) simplex = {simplex[1], simplex[0], simplex[3], simplex[2]};
  if (first == 2) simplex = {simplex[2], simplex[3], simplex[0], simplex[1]};
  if (first == 3) simplex = {simplex[3], simplex[2], simplex[1], simplex[0]};
  std::rotate(simplex.begin() + 1, std::min_element(simplex.begin() + 1, simplex.end()),
              simplex.end());
  return simplex;
}

inline FlatMesh flat(const StreamedMesh& mesh) {
  FlatMesh all;
  for (const MeshStreamBlock& block : mesh.blocks) {
    const StreamNumbers number(all.vertices.size(), block);
    all.vertices.insert(all.vertices.end(), block.vertices.begin(), block.vertices.end());
    all.input_index.insert(all.input_index.end(), block.input_index.begin(),
                           block.input_index.end());
    all.attributes.insert(all.attributes.end(), block.attributes.begin(), block.attributes.end());
    const std::size_t corners = mesh.header.dimension + 1;
    for (std::size_t i = 0; i < block.corners.size(); i += corners) {
      std::vector<std::uint64_t> simplex;
      for (std::size_t k = 0; k < corners; ++k) simplex.push_back(number[block.corners[i + k]]);
      all.simplices.push_back(turned(simplex));
    }
    for (const std::uint32_t n : block.finalized) {
      EXPECT_TRUE(all.finalized.emplace(number[n], all.simplices.size()).second);
    }
  }
  std::sort(all.simplices.begin(), all.simplices.end());
  return all;
}

}  // namespace spillway::test
