#include "stream/library/meshes/whole_mesh.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <limits>
#include <numeric>
#include <span>
#include <utility>
#include <vector>

#include "formats/blocks/block.h"
#include "formats/meshes/common/divided_block.h"
#include "formats/meshes/common/mesh_block.h"
#include "formats/meshes/common/periodic_mesh.h"
#include "src/error.h"
#include "src/geometry/dimensions.h"
#include "src/geometry/simplex_name.h"
#include "stream/checker/checker.h"

namespace spillway::stream {
namespace {

/// How many facets one simplex has, and one that more than two have, if there is any.
struct FacetCounts {
  std::uint64_t single = 0;
  std::vector<std::uint64_t> crowded{};  ///< its vertices
};

/// `Corners` is the number of vertices of a facet.
template <std::size_t Corners>
FacetCounts count_facets(const Mesh& mesh) {
  using Facet = std::array<std::uint64_t, Corners>;
  std::vector<Facet> facets;
  facets.reserve(mesh.corners.size());
  for (std::size_t simplex = 0; simplex < mesh.corners.size(); simplex += Corners + 1) {
    for (std::size_t opposite = 0; opposite <= Corners; ++opposite) {
      Facet facet{};
      auto place = facet.begin();
      for (std::size_t i = 0; i <= Corners; ++i) {
        if (i != opposite) *place++ = mesh.corners[simplex + i];
      }
      std::sort(facet.begin(), facet.end());
      facets.push_back(facet);
    }
  }
  std::sort(facets.begin(), facets.end());
  FacetCounts counts;
  for (auto facet = facets.begin(); facet != facets.end();) {
    const auto next =
        std::find_if(facet, facets.end(), [&](const Facet& f) { return f != *facet; });
    if (next - facet == 1) ++counts.single;
    if (next - facet > 2) counts.crowded.assign(facet->begin(), facet->end());
    facet = next;
  }
  return counts;
}

FacetCounts facets_of(const Mesh& mesh) {
  if (mesh.header.periodic) return {.single = checker::count_periodic_hull(mesh)};
  return with_dimension(mesh.header.dimension, [&](auto d) { return count_facets<d>(mesh); });
}

/// The vertices as a stream with this lattice has them. In the plane heights need not be on it;
/// then they have the identity map.
std::vector<LatticePoint> stream_vertices(const Mesh& mesh,
                                          std::optional<IntegerLattice>& lattice) {
  if (!lattice) return vertices_without_lattice(mesh);
  if (auto vertices = vertices_on_lattice(mesh, *lattice, 3)) return *std::move(vertices);
  if (mesh.header.dimension == 2) {
    lattice->scale[2] = 1;
    lattice->offset[2] = 0;
    if (auto vertices = vertices_on_lattice(mesh, *lattice, 2)) return *std::move(vertices);
  }
  lattice.reset();
  return vertices_without_lattice(mesh);
}

/// The mesh as one block, which keeps its simplices together as the file has them; with attributes
/// as several, where they might make it larger than a block can be.
std::vector<MeshStreamBlock> blocks_of(MeshStreamBlock whole, std::size_t corners,
                                       const AttributeLayout& attributes) {
  constexpr std::size_t kMostVertices = 65536;  // of one of several
  // Columns take at most so much of a vertex, and of a corner.
  const std::size_t vertex = 5 * sizeof(double) + 2 * attributes.record_size();
  const std::size_t corner = 2 * sizeof(std::uint32_t);
  const std::size_t most = whole.vertices.size() * vertex + whole.corners.size() * corner;
  std::vector<MeshStreamBlock> blocks;
  if (attributes.empty() || most <= kLargestBlock) {
    blocks.push_back(std::move(whole));
    return blocks;
  }
  const std::size_t size = std::clamp<std::size_t>(
      kLargestBlock / 8 / std::max<std::size_t>(1, most / whole.vertices.size()), 1, kMostVertices);
  return divided(whole, corners, attributes.record_size(), size);
}

/// The corners, those of simplices across the sides of a periodic box at the end, and their offsets.
void put_those_across_last(const Mesh& mesh, MeshStreamBlock& block) {
  const std::size_t size = mesh.corners_per_simplex();
  for (const bool across : {false, true}) {
    for (std::size_t at = 0; at < mesh.corners.size(); at += size) {
      const auto offsets = std::span(mesh.offsets).subspan(at, size);
      if (is_across(offsets) != across) continue;
      const auto corners = std::span(mesh.corners).subspan(at, size);
      block.corners.insert(block.corners.end(), corners.begin(), corners.end());
      if (across) block.offsets.insert(block.offsets.end(), offsets.begin(), offsets.end());
    }
  }
}

MeshTotals totals_of(const Mesh& mesh) {
  MeshTotals totals;
  totals.vertices = totals.points = mesh.vertices.size();
  totals.simplices = mesh.corners.size() / mesh.corners_per_simplex();
  return totals;
}

}  // namespace

std::optional<IntegerLattice> stream_lattice(const Mesh& mesh) {
  std::optional<IntegerLattice> lattice = mesh.header.lattice;
  stream_vertices(mesh, lattice);
  return lattice;
}

std::uint64_t count_boundary_facets(const Mesh& mesh) { return facets_of(mesh).single; }

WholeMesh::WholeMesh(Mesh mesh, const std::string& name, bool all_totals)
    : all_totals_(all_totals), totals_(totals_of(mesh)) {
  if (all_totals) {
    const FacetCounts facets = facets_of(mesh);
    totals_.hull_facets = facets.single;
    totals_.canonical_hash = canonical_hash(mesh);
    crowded_ = facets.crowded;
  }
  if (mesh.vertices.size() > std::numeric_limits<std::uint32_t>::max()) {
    throw Failure(
        fmt::format("{}: {} vertices are too many for a mesh that is not a stream; make it "
                    "as spm from the points",
                    name, mesh.vertices.size()),
        ErrorCode::kTooLarge, {.file = name});
  }
  header_.dimension = mesh.header.dimension;
  header_.has_input_index = mesh.header.has_input_index;
  header_.lattice = mesh.header.lattice;
  header_.crs = mesh.header.crs;
  header_.attributes = mesh.header.attributes;
  header_.periodic = mesh.header.periodic;
  MeshStreamBlock block;
  block.vertices = stream_vertices(mesh, header_.lattice);
  for (const LatticePoint& vertex : block.vertices) {
    extent_.expand(Point<2>{vertex[0], vertex[1]});
  }
  block.input_index = std::move(mesh.input_index);
  block.attributes = std::move(mesh.attributes);
  if (header_.periodic) {
    put_those_across_last(mesh, block);
  } else {
    block.corners.assign(mesh.corners.begin(), mesh.corners.end());
  }
  block.finalized.resize(block.vertices.size());
  std::iota(block.finalized.begin(), block.finalized.end(), 0U);
  blocks_ = blocks_of(std::move(block), mesh.corners_per_simplex(), header_.attributes);
}

void WholeMesh::refuse_crowded_facet(const std::string& name) const {
  if (crowded_.empty()) return;
  throw Failure(
      fmt::format("{}: more than two {} have the {} of the vertices {} (counted from 0), which spm "
                  "cannot hold; remove what is there twice",
                  name, simplices_of(header_.dimension), header_.dimension == 2 ? "edge" : "facet",
                  fmt::join(crowded_, ", ")),
      ErrorCode::kBadInput, {.file = name});
}

bool WholeMesh::read(MeshStreamBlock& block) {
  if (read_ == blocks_.size()) return false;
  block = std::move(blocks_[read_++]);
  return true;
}

}  // namespace spillway::stream
