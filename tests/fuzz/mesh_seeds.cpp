#include "formats/disk/scratch_folder.h"
#include "formats/meshes/mesh_formats.h"
#include "tests/formats/meshes/attributed_mesh.h"
#include "tests/formats/meshes/export_test_helpers.h"
#include "tests/formats/meshes/square_mesh.h"
#include "tests/fuzz/block_repair.h"
#include "tests/fuzz/file_bundle.h"
#include "tests/fuzz/seeds.h"

namespace spillway::test {
namespace {

Mesh tetrahedron() {
  Mesh mesh = square_mesh();
  mesh.header.dimension = 3;
  mesh.corners = {0, 1, 2, 3};
  mesh.header.simplices = 1;
  return mesh;
}

Mesh with_lattice(Mesh mesh, const MeshFormat& format) {
  mesh.header.lattice = IntegerLattice{{0.5, 0.5, 0.5}, {0, 0, 0}};
  if (!format.reads_crs) mesh.header.crs = "EPSG:25832";
  return mesh;
}

Mesh repeated(Mesh mesh) {
  mesh.header.periodic =
      PeriodicBox{.box = {{0, 0, 0}, {2, 2, 0}}, .periodic = {true, true, false}};
  mesh.offsets.assign(mesh.corners.size(), kNoOffset);
  mesh.offsets[1] = corner_offset(std::array{1, 0, 0});
  return mesh;
}

/// A mesh with all that the format holds, besides plain ones.
std::vector<Mesh> meshes_for(const MeshFormat& format) {
  std::vector<Mesh> meshes = {square_mesh(), with_lattice(square_mesh(), format)};
  if (format.most_dimension == 3) meshes.push_back(tetrahedron());
  if (format.holds_input_index) {
    meshes.push_back(square_mesh());
    add_input_index(meshes.back());
  }
  if (format.held_attributes != HeldAttributes::kNone) {
    meshes.push_back(square_mesh());
    add_attributes(meshes.back(), colours(), 1, 65535);
  }
  if (format.held_attributes == HeldAttributes::kAll) {
    meshes.push_back(square_mesh());
    add_attributes(meshes.back(), every_type(), 2, 100);
  }
  if (format.holds_offsets) meshes.push_back(repeated(square_mesh()));
  return meshes;
}

std::vector<StreamedMesh> streams_for(const MeshFormat& format) {
  std::vector<StreamedMesh> meshes = {strip(2, 12, 5)};
  if (format.most_dimension == 3) meshes.push_back(strip(3, 12, 5));
  const std::size_t plain = meshes.size();
  for (std::size_t i = 0; i < plain; ++i) {
    meshes.push_back(meshes[i]);
    leave_lattice(meshes.back());
    if (format.holds_input_index) add_input_index(meshes.back());
    if (format.held_attributes == HeldAttributes::kAll) {
      add_attributes(meshes.back(), scaled_attributes(), 3, 100);
    }
  }
  if (format.holds_offsets) {
    meshes.push_back(strip(2, 12, 5));
    meshes.back().header.periodic =
        PeriodicBox{.box = {{0, 0, 0}, {1e6, 1e7, 0}}, .periodic = {true, true, false}};
    leave_lattice(meshes.back());
    for (MeshStreamBlock& block : meshes.back().blocks) {
      block.offsets.assign(block.corners.size(), kNoOffset);
      block.offsets[1] = corner_offset(std::array{1, 0, 0});
    }
  }
  return meshes;
}

std::string written_files(const MeshFormat& format, const Mesh& mesh) {
  FaultyFileSystem files;
  const std::string path = "a." + std::string(format.extensions.front());
  write_mesh(files, path, format, mesh);
  return format.file_set != nullptr ? bundled(files.files) : files.files.begin()->second;
}

std::string streamed(const MeshFormat& format, const StreamedMesh& mesh) {
  FaultyFileSystem files;
  const auto scratch = make_scratch_folder("", std::nullopt);
  const auto writer = open_mesh_stream_writer(files, "a", format, mesh.header, *scratch);
  write_blocks(*writer, mesh);
  return files.files.at("a");
}

void add_written(const MeshFormat& format, std::vector<std::string>& seeds) {
  if (format.open_writer != nullptr) {
    for (const Mesh& mesh : meshes_for(format)) seeds.push_back(written_files(format, mesh));
  }
  if (format.open_block_writer != nullptr) {
    for (const StreamedMesh& mesh : streams_for(format)) seeds.push_back(streamed(format, mesh));
  }
}

}  // namespace

std::vector<std::string> mesh_seeds(const MeshFormat& format) {
  std::vector<std::string> seeds = foreign_meshes(format.name);
  bool is_meant = false;
  for (const MeshFormat* const other : mesh_formats()) {
    is_meant = *other == format || (is_meant && other->is_variant);
    if (is_meant) add_written(*other, seeds);
  }
  if (format == own_mesh_stream()) {
    const std::size_t written = seeds.size();
    for (std::size_t i = 0; i < written; ++i) seeds.push_back(with_plain_blocks(seeds[i]));
  }
  return seeds;
}

}  // namespace spillway::test
