#pragma once
// Meshes as streams in memory, for tests of what reads them.

#include <algorithm>
#include <cstdint>
#include <span>
#include <unordered_map>
#include <utility>
#include <vector>

#include "formats/meshes/common/mesh.h"
#include "formats/meshes/common/mesh_stream.h"
#include "src/geometry/predicates.h"

namespace spillway::test {

/// A stream that lies in memory.
class StreamInMemory : public MeshStreamReader {
 public:
  [[nodiscard]] const MeshStreamHeader& header() const override { return stream_header; }
  bool read(MeshStreamBlock& block) override {
    if (next_ == blocks.size()) return false;
    block = blocks[next_++];
    return true;
  }
  [[nodiscard]] const MeshTotals& totals() const override { return stream_totals; }
  [[nodiscard]] bool has_hash() const override { return with_hash; }
  [[nodiscard]] std::optional<double> fraction_read() const override {
    return static_cast<double>(next_) / static_cast<double>(blocks.size());
  }

  MeshStreamHeader stream_header;
  std::vector<MeshStreamBlock> blocks;
  MeshTotals stream_totals;
  bool with_hash = true;

 private:
  std::size_t next_ = 0;
};

inline void append_vertex(const Mesh& mesh, std::uint64_t v, MeshStreamBlock& block) {
  const std::size_t size = mesh.header.attributes.record_size();
  const auto record = std::span(mesh.attributes).subspan(v * size, size);
  block.vertices.emplace_back(mesh.vertices[v].numbers());
  block.attributes.insert(block.attributes.end(), record.begin(), record.end());
}

/// The mesh, its simplices in their order, so many in a block. Vertices come right before their
/// first simplex and are finalized right after their last; unused ones are in the last block. The
/// mesh's vertices are as blocks shall hold them, on its lattice if it has one. Totals other than
/// the counts of vertices and simplices are left to the caller.
inline StreamInMemory stream_of(const Mesh& mesh, std::size_t simplices_in_block) {
  StreamInMemory stream;
  stream.stream_header.dimension = mesh.header.dimension;
  stream.stream_header.lattice = mesh.header.lattice;
  stream.stream_header.attributes = mesh.header.attributes;
  stream.stream_totals.vertices = mesh.vertices.size();
  const std::size_t corners = mesh.corners_per_simplex();
  stream.stream_totals.simplices = mesh.corners.size() / corners;
  std::vector<std::size_t> last_corner(mesh.vertices.size());
  for (std::size_t c = 0; c < mesh.corners.size(); ++c) last_corner[mesh.corners[c]] = c;
  std::vector<std::uint64_t> number(mesh.vertices.size(), ~std::uint64_t{0});
  std::uint64_t announced = 0;
  const std::size_t step = simplices_in_block * corners;
  for (std::size_t begin = 0; begin < mesh.corners.size(); begin += step) {
    const std::size_t end = std::min(begin + step, mesh.corners.size());
    const auto is_old = [&](std::uint64_t v) { return number[v] != ~std::uint64_t{0}; };
    MeshStreamBlock block;
    std::vector<std::uint64_t> fresh;
    std::vector<std::uint64_t> old;
    std::unordered_map<std::uint64_t, std::uint32_t> short_number;
    for (std::size_t c = begin; c < end; ++c) {
      auto& list = is_old(mesh.corners[c]) ? old : fresh;
      if (short_number.try_emplace(mesh.corners[c], 0).second) list.push_back(mesh.corners[c]);
    }
    for (const std::uint64_t v : old) block.imported.push_back(number[v]);
    for (const std::uint64_t v : fresh) {
      number[v] = announced++;
      append_vertex(mesh, v, block);
    }
    std::vector<std::uint64_t> all = fresh;
    all.insert(all.end(), old.begin(), old.end());
    for (std::uint32_t i = 0; i < all.size(); ++i) {
      short_number[all[i]] = i;
      if (last_corner[all[i]] < end) block.finalized.push_back(i);
    }
    for (std::size_t c = begin; c < end; ++c) {
      block.corners.push_back(short_number[mesh.corners[c]]);
    }
    stream.blocks.push_back(std::move(block));
  }
  if (stream.blocks.empty()) stream.blocks.emplace_back();
  MeshStreamBlock& last = stream.blocks.back();
  std::vector<std::uint64_t> unused;
  for (std::uint64_t v = 0; v < number.size(); ++v) {
    if (number[v] == ~std::uint64_t{0}) unused.push_back(v);
  }
  const auto shift = [&](std::uint32_t& i) {  // imported ones come after the new ones
    if (i >= last.vertices.size()) i += static_cast<std::uint32_t>(unused.size());
  };
  std::for_each(last.corners.begin(), last.corners.end(), shift);
  std::for_each(last.finalized.begin(), last.finalized.end(), shift);
  for (const std::uint64_t v : unused) {
    last.finalized.push_back(static_cast<std::uint32_t>(last.vertices.size()));
    append_vertex(mesh, v, last);
  }
  return stream;
}

/// Sorts the simplices by their first corner's place along an axis, as a sweep would find them.
template <int D>
void sort_along(Mesh& mesh, int axis) {
  std::vector<std::array<std::uint64_t, D + 1>> simplices;
  for (std::size_t c = 0; c < mesh.corners.size(); c += D + 1) {
    std::copy_n(mesh.corners.begin() + static_cast<std::ptrdiff_t>(c), D + 1,
                simplices.emplace_back().begin());
  }
  std::stable_sort(simplices.begin(), simplices.end(), [&](const auto& a, const auto& b) {
    return mesh.vertices[a[0]][axis] < mesh.vertices[b[0]][axis];
  });
  mesh.corners.clear();
  for (const auto& simplex : simplices) {
    mesh.corners.insert(mesh.corners.end(), simplex.begin(), simplex.end());
  }
}

}  // namespace spillway::test
