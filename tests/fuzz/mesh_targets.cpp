// Every format of meshes, as a file and as a pipe.

#include <cmath>
#include <cstdint>
#include <string>

#include "formats/inputs/open_mesh.h"
#include "formats/meshes/common/periodic_mesh.h"
#include "formats/meshes/mesh_formats.h"
#include "tests/faulty_file_system.h"
#include "tests/fuzz/block_repair.h"
#include "tests/fuzz/file_bundle.h"
#include "tests/fuzz/seeds.h"
#include "tests/fuzz/target.h"

namespace spillway::test {
namespace {

/// What a mesh has to be, whatever is read.
void check_mesh(const Mesh& mesh) {
  expect_kept(mesh.header.vertices == mesh.vertices.size(), "the header tells the vertices");
  expect_kept(mesh.corners.size() == mesh.header.simplices * mesh.corners_per_simplex(),
              "the header tells the simplices");
  for (const std::uint64_t corner : mesh.corners) {
    expect_kept(corner < mesh.vertices.size(), "corners are vertices");
  }
  for (const WorldPoint& vertex : mesh.vertices) {
    for (int k = 0; k < 3; ++k) expect_kept(std::isfinite(vertex[k]), "coordinates are finite");
  }
  expect_kept(mesh.input_index.size() == (mesh.header.has_input_index ? mesh.vertices.size() : 0),
              "each vertex has an input index, or none has");
  expect_kept(mesh.attributes.size() == mesh.header.attributes.record_size() * mesh.vertices.size(),
              "each vertex has a record of attributes");
  expect_kept(mesh.offsets.size() == (mesh.header.periodic ? mesh.corners.size() : 0),
              "each corner of a periodic mesh has an offset");
}

void read_mesh_in_both_ways(const MeshFormat& format, std::string_view bytes) {
  const std::string path = "a." + std::string(format.extensions.front());
  FaultyFileSystem files;
  if (format.file_set != nullptr) {
    files.files = unbundled(bytes);
  } else {
    files.files[path] = bytes;
  }
  files.seekable = false;
  try {
    check_mesh(read_mesh(files, path, std::string(format.name)));
  } catch (const Failure&) {
    // Some are not read from pipes at all.
  }
  files.seekable = true;
  is_mesh(files, path);
  check_mesh(read_mesh(files, path, std::string(format.name)));
}

}  // namespace

std::vector<FuzzTarget> mesh_targets() {
  std::vector<FuzzTarget> targets;
  for (const MeshFormat* const format : mesh_formats()) {
    if (format->is_table()) continue;  // which GDAL reads, from the disk
    if (format->is_variant) continue;  // read by the reader of another
    const bool has_checksums = *format == own_mesh_stream();
    targets.push_back({"mesh-" + std::string(format->name),
                       [format, has_checksums](std::string_view bytes) {
                         read_mesh_in_both_ways(*format, has_checksums ? with_right_checksums(bytes)
                                                                       : std::string(bytes));
                       },
                       [format] { return mesh_seeds(*format); }});
  }
  return targets;
}

}  // namespace spillway::test
