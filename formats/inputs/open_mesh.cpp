#include "formats/inputs/open_mesh.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <memory>
#include <optional>
#include <string_view>
#include <utility>

#include "formats/bytes/bytes.h"
#include "formats/bytes/input_source.h"
#include "formats/disk/extension.h"
#include "formats/inputs/open_points.h"
#include "formats/meshes/common/mesh_block.h"
#include "formats/meshes/common/mesh_writer.h"
#include "formats/meshes/glb/glb_format.h"
#include "formats/meshes/glb/glb_reader.h"
#include "formats/meshes/landxml/landxml_reader.h"
#include "formats/meshes/mesh_format.h"
#include "formats/meshes/npy/npy_mesh.h"
#include "formats/meshes/obj/obj_reader.h"
#include "formats/meshes/off/off_reader.h"
#include "formats/meshes/ply/ply_header.h"
#include "formats/meshes/ply/ply_reader.h"
#include "formats/meshes/sma/sma_reader.h"
#include "formats/meshes/spm/spm_format.h"
#include "formats/meshes/spm/spm_reader.h"
#include "formats/meshes/stl/stl_format.h"
#include "formats/meshes/stl/stl_reader.h"
#include "formats/meshes/vector/vector_mesh.h"
#include "formats/meshes/vtu/vtu_reader.h"
#include "formats/points/common/point_reader.h"
#include "formats/points/npy/npy_header.h"
#include "formats/points/point_format.h"
#include "src/error.h"
#include "src/geometry/lattice_check.h"

namespace spillway::detail {
namespace {

constexpr std::size_t kProbe = 1024;

// A GeoPackage is a SQLite database.
constexpr std::string_view kSqliteMagic("SQLite format 3\0", 16);
constexpr std::string_view kShapefileMagic("\x00\x00\x27\x0a", 4);

/// Whether the text begins with `word`, and with nothing that makes it longer.
bool begins_with_word(std::string_view text, std::string_view word) {
  return text.starts_with(word) &&
         (text.size() == word.size() ||
          std::isspace(static_cast<unsigned char>(text[word.size()])) != 0);
}

/// The format that a name alone tells; npy is not among them, as points have it too.
std::optional<MeshFormat> format_of_name(const std::string& path) {
  const std::string extension = extension_of(path);
  if (extension == "ply") return MeshFormat::kPly;
  if (extension == "obj") return MeshFormat::kObj;
  if (extension == "off") return MeshFormat::kOff;
  if (extension == "vtu") return MeshFormat::kVtu;
  if (extension == "spm") return MeshFormat::kSpm;
  if (extension == "sma") return MeshFormat::kSma;
  if (extension == "glb") return MeshFormat::kGlb;
  if (extension == "stl") return MeshFormat::kStl;
  if (extension == "gpkg") return MeshFormat::kGpkg;
  if (extension == "shp") return MeshFormat::kShp;
  return std::nullopt;
}

/// Whether a PLY file has simplices. What is wrong with its header is left to read_mesh() to say.
bool is_ply_mesh(InputSource& source) {
  try {
    return read_ply_header(source).simplices() != nullptr;
  } catch (const Error&) {
    return true;
  }
}

/// Throws Error if this is the index of VTU parts.
void refuse_index_of_parts(InputSource& source) {
  if (as_text(source.peek(kProbe)).find("\"PUnstructuredGrid\"") != std::string_view::npos) {
    throw Error(
        fmt::format("{}: this is the index of a mesh's parts, which is for viewers; name one of "
                    "the parts, or, to check the whole, write it to one file",
                    source.name()),
        ErrorCode::kBadInput, {.file = source.name(), .remedy = Remedy::kOneFile});
  }
}

/// Throws Error if the file begins as points do, whatever its name says.
void refuse_points(InputSource& source) {
  const std::string_view text = as_text(source.peek(kProbe));
  const bool is_npy = text.starts_with(kNpyMagic);  // which fail_for_unknown() tells about
  if (is_npy || !begins_as_points(source.peek(kProbe))) return;
  throw Error(
      fmt::format("{}: this begins as {}, not as a mesh; triangulate it first", source.name(),
                  text.starts_with("LASF") ? "points in LAS" : "points or compressed data"));
}

/// Throws Error for a GeoPackage or Shapefile in a pipe, which nobody could open by its name again.
void refuse_pipe_of_tables(const InputSource& source, const std::string& path,
                           std::optional<MeshFormat> format) {
  if (format != MeshFormat::kGpkg && format != MeshFormat::kShp) return;
  if (path != "-" && source.size()) return;
  throw Error(fmt::format("{}: a GeoPackage or Shapefile is not read from a pipe; name the file",
                          source.name()));
}

[[noreturn]] void fail_for_unknown(InputSource& source, const std::string& path) {
  if (as_text(source.peek(kProbe)).starts_with(kNpyMagic)) {
    const NpyMeshNames names = npy_mesh_names(path);
    throw Error(
        fmt::format("{}: this is one npy array, but a mesh is two, such as {} and {}; name "
                    "one of these",
                    source.name(), names.vertices, names.simplices));
  }
  throw Error(
      fmt::format("{}: this is no mesh that is known: it begins neither as PLY nor as OFF nor "
                  "as VTU nor as spm, and has not the name of another format; convert it or name "
                  "its format",
                  source.name()));
}

/// Whether `path` names an npy mesh and nothing else: one of its files, or no file at all.
bool is_npy_mesh(const FileSystem& files, const std::string& path) {
  const std::optional<NpyMeshNames> names = find_npy_mesh(files, path);
  return names && (path == names->vertices || path == names->simplices || !files.exists(path));
}

Mesh read_npy(FileSystem& files, const std::string& path) {
  if (const std::optional<NpyMeshNames> names = find_npy_mesh(files, path)) {
    return read_npy_mesh(files, *names);
  }
  const NpyMeshNames names = npy_mesh_names(path);
  throw Error(
      fmt::format("{}: an npy mesh is two files, such as {} and {}, which are not both there", path,
                  names.vertices, names.simplices));
}

/// The whole of a stream, in output coordinates.
Mesh collect(MeshStreamReader& stream) {
  Mesh mesh;
  mesh.header.dimension = stream.header().dimension;
  mesh.header.has_input_index = stream.header().has_input_index;
  mesh.header.lattice = stream.header().lattice;
  mesh.header.crs = stream.header().crs;
  MeshBlock block;
  while (stream.read(block)) {
    append_stream_numbers(block, mesh.vertices.size(), mesh.corners);
    move_to_world(stream.header(), block);
    mesh.vertices.insert(mesh.vertices.end(), block.vertices.begin(), block.vertices.end());
    mesh.input_index.insert(mesh.input_index.end(), block.input_index.begin(),
                            block.input_index.end());
  }
  mesh.header.vertices = mesh.vertices.size();
  mesh.header.simplices = mesh.corners.size() / mesh.corners_per_simplex();
  return mesh;
}

Mesh read_any_mesh(FileSystem& files, const std::string& path, const std::string& format_name) {
  std::optional<MeshFormat> format;
  if (!format_name.empty()) format = mesh_format(path, format_name);
  if (format == MeshFormat::kNpy || (!format && is_npy_mesh(files, path))) {
    return read_npy(files, path);
  }
  auto source = std::make_unique<InputSource>(files.open(path));
  refuse_pipe_of_tables(*source, path, format);
  refuse_index_of_parts(*source);
  if (!format) format = mesh_format_of_content(*source);
  if (!format) refuse_points(*source);
  if (!format) format = format_of_name(path);
  if (!format) fail_for_unknown(*source, path);
  refuse_pipe_of_tables(*source, path, format);
  switch (*format) {
    case MeshFormat::kObj:
      return read_obj(*source);
    case MeshFormat::kOff:
      return read_off(*source);
    case MeshFormat::kVtu:
      return read_vtu(*source);
    case MeshFormat::kSpm:
      return collect(*open_spm_reader(std::move(source)));
    case MeshFormat::kSma:
      return collect(*open_sma_reader(std::move(source)));
    case MeshFormat::kGlb:
      return read_glb(*source);
    case MeshFormat::kStl:
      return read_stl(*source);
    case MeshFormat::kLandXml:
      return read_landxml(*source);
    case MeshFormat::kGpkg:
    case MeshFormat::kShp:
      return read_vector_mesh(path);
    default:
      return read_ply(*source);
  }
}

/// Whether all vertices are on the header's lattice, z of the plane apart.
bool is_on_lattice(const Mesh& mesh) {
  return std::ranges::all_of(mesh.vertices, [&](const Point<3>& vertex) {
    for (int k = 0; k < mesh.header.dimension; ++k) {
      if (!mesh.header.lattice->to_integer(k, vertex[k])) return false;
    }
    return true;
  });
}

/// A lattice that vertices are not on says nothing of them.
void check_lattice_of(const Mesh& mesh, const std::string& path) {
  if (!mesh.header.lattice) return;
  const Lattice& lattice = *mesh.header.lattice;
  const Box<3> integers = integers_of(lattice, box_around(mesh.vertices));
  if (is_exact(lattice, integers, mesh.header.dimension) || !is_on_lattice(mesh)) return;
  check_lattice(path, lattice, integers, mesh.header.dimension);
}

}  // namespace

std::optional<MeshFormat> mesh_format_of_content(InputSource& source) {
  const std::string_view text = as_text(source.peek(kProbe));
  if (begins_with_word(text, "ply")) return MeshFormat::kPly;
  if (begins_with_word(text, "OFF")) return MeshFormat::kOff;
  // Of OBJ, which has no magic number, only Spillway's own is recognised.
  if (begins_with_word(text, "# spillway dimension")) return MeshFormat::kObj;
  if (begins_with_word(text, kSmaNote)) return MeshFormat::kSma;
  if (text.starts_with(kSpmMagic)) return MeshFormat::kSpm;
  if (text.starts_with('<') && text.find("<VTKFile") != text.npos) return MeshFormat::kVtu;
  if (text.find("<LandXML") != text.npos) return MeshFormat::kLandXml;
  if (text.starts_with(glb::kMagic)) return MeshFormat::kGlb;
  if (text.starts_with(kStlOrigin) || looks_like_ascii_stl(text)) return MeshFormat::kStl;
  if (text.starts_with(kSqliteMagic)) return MeshFormat::kGpkg;
  if (text.starts_with(kShapefileMagic)) return MeshFormat::kShp;
  return std::nullopt;
}

bool is_mesh(FileSystem& files, const std::string& path) {
  if (path == "-") return false;
  if (is_npy_mesh(files, path)) return true;
  InputSource source(files.open(path));
  std::optional<MeshFormat> format = mesh_format_of_content(source);
  if (!format && !begins_as_points(source.peek(kProbe))) format = format_of_name(path);
  return format == MeshFormat::kPly ? is_ply_mesh(source) : format.has_value();
}

Mesh read_mesh(FileSystem& files, const std::string& path, const std::string& format_name) {
  Mesh mesh = read_any_mesh(files, path, format_name);
  check_lattice_of(mesh, path);
  return mesh;
}

}  // namespace spillway::detail
