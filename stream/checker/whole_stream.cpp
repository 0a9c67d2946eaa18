#include "stream/checker/whole_stream.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <numeric>

#include "formats/meshes/common/mesh_block.h"
#include "src/error.h"
#include "src/geometry/simplex_name.h"

namespace spillway::checker {

WholeStream::WholeStream(const Mesh& mesh) : mesh_(mesh) {
  if (mesh.vertices.size() > std::numeric_limits<std::uint32_t>::max()) {
    throw Failure(fmt::format("{} vertices are too many for a periodic mesh that is not a stream; "
                              "make it as spm from the points",
                              mesh.vertices.size()),
                  ErrorCode::kTooLarge);
  }
  const std::size_t corners = mesh.corners_per_simplex();
  if (mesh.corners.size() % corners != 0 || mesh.offsets.size() != mesh.corners.size()) {
    throw Failure(fmt::format("a periodic mesh has {} corners and {} offsets of corners",
                              mesh.corners.size(), mesh.offsets.size()),
                  ErrorCode::kBadInput);
  }
  for (std::size_t c = 0; c < mesh.corners.size(); ++c) {
    if (mesh.corners[c] < mesh.vertices.size()) continue;
    throw Failure(fmt::format("{} {} names vertex {}, but the mesh has {} vertices",
                              geometry::simplex_of(mesh.header.dimension), c / corners,
                              mesh.corners[c], mesh.vertices.size()),
                  ErrorCode::kBadInput, {.place = at_record(c / corners)});
  }
  header_.dimension = mesh.header.dimension;
  header_.periodic = mesh.header.periodic;
  totals_.vertices = totals_.points = mesh.vertices.size();
  totals_.simplices = mesh.corners.size() / corners;
}

bool WholeStream::read(MeshStreamBlock& block) {
  block.clear();
  if (ended_) return false;
  ended_ = true;
  block.vertices = vertices_without_lattice(mesh_);
  block.corners.assign(mesh_.corners.begin(), mesh_.corners.end());
  const auto first =
      std::ranges::find_if(mesh_.offsets, [](CornerOffset offset) { return offset != kNoOffset; });
  const auto at = first - mesh_.offsets.begin();
  const auto corners = static_cast<std::ptrdiff_t>(mesh_.corners_per_simplex());
  block.offsets.assign(mesh_.offsets.begin() + at / corners * corners, mesh_.offsets.end());
  block.finalized.resize(block.vertices.size());
  std::iota(block.finalized.begin(), block.finalized.end(), 0U);
  return true;
}

}  // namespace spillway::checker
