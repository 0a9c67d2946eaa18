#include "stream/checker/checker.h"

#include <algorithm>
#include <cmath>

#include "src/error.h"
#include "src/geometry/canonical_hash.h"
#include "src/geometry/dimensions.h"
#include "stream/checker/mesh_proof.h"
#include "stream/checker/stream_proof.h"
#include "stream/checker/whole_stream.h"

namespace spillway::checker {
namespace {

void require_dimension(int dimension) {
  if (!is_dimension(dimension)) {
    throw Failure(
        fmt::format("a mesh of dimension {} cannot be checked: only 2 to 6 can", dimension),
        ErrorCode::kInvalidArgument);
  }
}

template <int D>
std::uint64_t hash_of(const Mesh& mesh) {
  CanonicalHash<D> hash;
  for (std::size_t s = 0; s + D < mesh.corners.size(); s += D + 1) {
    std::array<Point<D>, D + 1> simplex;
    for (int i = 0; i <= D; ++i) {
      const std::uint64_t vertex = mesh.corners[s + i];
      if (vertex >= mesh.vertices.size()) {
        throw Failure(fmt::format("{} {} names vertex {}, but the mesh has {} vertices",
                                  Words<D>::kSimplex, s / (D + 1), vertex, mesh.vertices.size()),
                      ErrorCode::kBadInput, {.place = at_record(s / (D + 1))});
      }
      simplex[i] = mesh.vertex<D>(vertex);
    }
    hash.add(simplex);
  }
  return hash.value();
}

CheckReport read_stream(MeshStreamReader& reader, const CheckerOptions& options, StreamTask task) {
  require_dimension(reader.header().dimension);
  CheckReport report;
  with_dimension(reader.header().dimension,
                 [&](auto d) { prove_stream<d>(reader, options, task, report); });
  return report;
}

/// On the lattice of the mesh, if it has one. What is held at a time says nothing of a mesh that is
/// in memory.
CheckReport check_periodic_mesh(const Mesh& mesh, CheckerOptions options) {
  if (mesh.header.lattice) options.input_lattice = mesh.header.lattice;
  options.vertex = {};
  options.progress = {};
  WholeStream stream(mesh);
  CheckReport report = read_stream(stream, options, StreamTask::kProve);
  report.peak_live_vertices = 0;
  report.peak_open_facets = 0;
  return report;
}

}  // namespace

CheckReport check_mesh(const Mesh& mesh, const CheckerOptions& options) {
  require_dimension(mesh.header.dimension);
  if (mesh.header.periodic) return check_periodic_mesh(mesh, options);
  CheckReport report;
  report.vertices = mesh.vertices.size();
  report.simplices = mesh.corners.size() / mesh.corners_per_simplex();
  with_dimension(mesh.header.dimension, [&](auto d) { prove_mesh<d>(mesh, options, report); });
  return report;
}

CheckReport check_mesh_stream(MeshStreamReader& reader, const CheckerOptions& options) {
  return read_stream(reader, options, StreamTask::kProve);
}

CheckReport count_mesh_stream(MeshStreamReader& reader, const CheckerOptions& options) {
  return read_stream(reader, options, StreamTask::kCount);
}

std::uint64_t count_periodic_hull(const Mesh& mesh) {
  WholeStream stream(mesh);
  return read_stream(stream, {}, StreamTask::kCount).hull_facets;
}

std::uint64_t canonical_hash(const Mesh& mesh) {
  require_dimension(mesh.header.dimension);
  return with_dimension(mesh.header.dimension, [&](auto d) { return hash_of<d>(mesh); });
}

}  // namespace spillway::checker
