#include "formats/inputs/open_mesh.h"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <string_view>
#include <utility>
#include <vector>

#include "formats/bytes/bytes.h"
#include "formats/inputs/open_points.h"
#include "formats/meshes/common/mesh_block.h"
#include "formats/points/point_formats.h"
#include "src/error.h"
#include "src/geometry/lattice_check.h"

namespace spillway::formats {
namespace {

constexpr std::size_t kProbe = 1024;

/// Whether a file has simplices. What is wrong with its header is left to read_mesh() to say.
bool has_simplices(const MeshFormat& format, InputBytes& source) {
  try {
    return format.has_simplices == nullptr || format.has_simplices(source);
  } catch (const Failure&) {
    return true;
  }
}

/// The format in several files that `path` names a mesh of, and nothing else; null if there is no
/// such mesh.
const MeshFormat* format_of_files(const FileSystem& files, const std::string& path,
                                  MeshFormats formats) {
  for (const MeshFormat* const format : formats) {
    if (format->file_set != nullptr && format->file_set->is_meant(files, path)) return format;
  }
  return nullptr;
}

/// Throws Failure if the file is one of those of a mesh in several, or begins as points do, whatever
/// its name says.
void refuse_what_is_no_mesh(InputBytes& source, const std::string& path, MeshFormats formats) {
  for (const MeshFormat* const format : formats) {
    if (format->file_set != nullptr) format->file_set->check_is_no_part(source, path);
  }
  const std::span<const std::byte> first_bytes = source.peek(kProbe);
  if (!begins_as_points(first_bytes)) return;
  const PointFormat* const points = point_format_of_bytes(as_text(first_bytes));
  throw BadInput(source.name(),
                 fmt::format("this begins as {}, not as a mesh; triangulate it first",
                             points != nullptr ? fmt::format("points in {}", points->title)
                                               : "compressed data"),
                 at_byte(0));
}

/// Throws Failure for a table in a pipe, which nobody could open by its name again.
void refuse_pipe_of_tables(const InputBytes& source, const std::string& path,
                           const MeshFormat& format) {
  if (!format.is_table() || (path != "-" && source.size())) return;
  throw BadInput(source.name(),
                 fmt::format("a {} is not read from a pipe; name the file", format.title));
}

[[noreturn]] void fail_for_unknown(const InputBytes& source, MeshFormats formats) {
  std::vector<std::string> titles;
  for (const MeshFormat* const format : formats) {
    if (format->recognises != nullptr) titles.emplace_back(format->title);
  }
  throw BadInput(
      source.name(),
      fmt::format("not a mesh format that Spillway knows: the file begins neither as {}, "
                  "and its name is not that of a format; convert it or name its format",
                  fmt::join(titles, " nor as ")),
      at_byte(0));
}

Mesh read_as(const MeshFormat& format, std::unique_ptr<InputBytes> source, const std::string& path,
             std::uint64_t max_expansion) {
  refuse_pipe_of_tables(*source, path, format);
  if (format.is_table()) return format.read_table(path);
  if (format.is_stream()) return collect_mesh(*format.open_stream(std::move(source)));
  return format.read(*source, max_expansion);
}

Mesh read_any_mesh(FileSystem& files, const std::string& path, const std::string& format_name,
                   MeshFormats formats, std::uint64_t max_expansion) {
  const MeshFormat* format = format_name.empty() ? format_of_files(files, path, formats)
                                                 : &mesh_format(path, format_name, formats);
  if (format != nullptr && format->file_set != nullptr) {
    Mesh mesh = format->file_set->read(files, path);
    mesh.format = format->name;
    return mesh;
  }
  auto source = std::make_unique<InputBytes>(files.open(path));
  if (format == nullptr) format = mesh_format_of_content(*source, formats);
  if (format == nullptr) refuse_what_is_no_mesh(*source, path, formats);
  if (format == nullptr) format = mesh_format_of_name(path, formats);
  if (format == nullptr) fail_for_unknown(*source, formats);
  Mesh mesh = read_as(*format, std::move(source), path, max_expansion);
  mesh.format = format->name;
  return mesh;
}

/// Whether all vertices are on the header's lattice, z of the plane apart.
bool is_on_lattice(const Mesh& mesh) {
  return std::ranges::all_of(mesh.vertices, [&](const WorldPoint& vertex) {
    for (int k = 0; k < mesh.header.dimension; ++k) {
      if (!mesh.header.lattice->to_integer(k, vertex[k])) return false;
    }
    return true;
  });
}

/// A lattice that vertices are not on says nothing of them.
void check_lattice_of(const Mesh& mesh, const std::string& path) {
  if (!mesh.header.lattice) return;
  const IntegerLattice& lattice = *mesh.header.lattice;
  const Box<3> integers = integers_of(lattice, box_around(mesh.vertices));
  if (is_exact(lattice, integers, mesh.header.dimension) || !is_on_lattice(mesh)) return;
  check_lattice({path}, lattice, integers, mesh.header.dimension);
}

}  // namespace

Mesh collect_mesh(MeshStreamReader& stream) {
  Mesh mesh;
  mesh.header.dimension = stream.header().dimension;
  mesh.header.has_input_index = stream.header().has_input_index;
  mesh.header.lattice = stream.header().lattice;
  mesh.header.crs = stream.header().crs;
  mesh.header.attributes = stream.header().attributes;
  mesh.header.periodic = stream.header().periodic;
  MeshStreamBlock block;
  while (stream.read(block)) {
    append_stream_numbers(block, mesh.vertices.size(), mesh.corners);
    const std::vector<WorldPoint> vertices = world_vertices(stream.header(), block);
    mesh.vertices.insert(mesh.vertices.end(), vertices.begin(), vertices.end());
    mesh.input_index.insert(mesh.input_index.end(), block.input_index.begin(),
                            block.input_index.end());
    mesh.attributes.insert(mesh.attributes.end(), block.attributes.begin(), block.attributes.end());
    if (!mesh.header.periodic) continue;
    mesh.offsets.resize(mesh.corners.size() - block.offsets.size(), kNoOffset);
    mesh.offsets.insert(mesh.offsets.end(), block.offsets.begin(), block.offsets.end());
  }
  mesh.header.vertices = mesh.vertices.size();
  mesh.header.simplices = mesh.corners.size() / mesh.corners_per_simplex();
  return mesh;
}

const MeshFormat* mesh_format_of_content(InputBytes& source, MeshFormats formats) {
  return mesh_format_of_bytes(as_text(source.peek(kProbe)), formats);
}

bool is_mesh(FileSystem& files, const std::string& path, MeshFormats formats) {
  if (path == "-") return false;
  if (format_of_files(files, path, formats) != nullptr) return true;
  InputBytes source(files.open(path));
  const MeshFormat* format = mesh_format_of_content(source, formats);
  if (format == nullptr && !begins_as_points(source.peek(kProbe))) {
    format = mesh_format_of_name(path, formats);
  }
  return format != nullptr && has_simplices(*format, source);
}

Mesh read_mesh(FileSystem& files, const std::string& path, const std::string& format_name,
               MeshFormats formats, std::uint64_t max_expansion) {
  Mesh mesh = read_any_mesh(files, path, format_name, formats, max_expansion);
  check_lattice_of(mesh, path);
  return mesh;
}

}  // namespace spillway::formats
