#include "formats/mesh_writer.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <utility>

#include "formats/glb_writer.h"
#include "formats/landxml_writer.h"
#include "formats/npy_mesh.h"
#include "formats/obj_writer.h"
#include "formats/off_writer.h"
#include "formats/ply_writer.h"
#include "formats/point_format.h"
#include "formats/vtu_writer.h"
#include "src/error.h"

namespace spillway::detail {
namespace {

struct NamedFormat {
  std::string_view name;
  MeshFormat format;
};

constexpr std::array kFormats = {
    NamedFormat{"ply", MeshFormat::kPly},         NamedFormat{"ply-ascii", MeshFormat::kPlyAscii},
    NamedFormat{"obj", MeshFormat::kObj},         NamedFormat{"off", MeshFormat::kOff},
    NamedFormat{"vtu", MeshFormat::kVtu},         NamedFormat{"npy", MeshFormat::kNpy},
    NamedFormat{"spm", MeshFormat::kSpm},         NamedFormat{"sma", MeshFormat::kSma},
    NamedFormat{"glb", MeshFormat::kGlb},         NamedFormat{"stl", MeshFormat::kStl},
    NamedFormat{"landxml", MeshFormat::kLandXml}, NamedFormat{"gpkg", MeshFormat::kGpkg},
    NamedFormat{"shp", MeshFormat::kShp}};

/// What the formats of triangles only are called in messages; nothing for the others.
std::string_view triangle_format(MeshFormat format) {
  switch (format) {
    case MeshFormat::kObj:
      return "OBJ";
    case MeshFormat::kOff:
      return "OFF";
    case MeshFormat::kSma:
      return "SMA";
    case MeshFormat::kGlb:
      return "glTF";
    case MeshFormat::kStl:
      return "STL";
    case MeshFormat::kLandXml:
      return "LandXML";
    case MeshFormat::kGpkg:
      return "GeoPackage";
    case MeshFormat::kShp:
      return "Shapefile";
    default:
      return "";
  }
}

/// Throws UsageError if the format, of triangles only, cannot hold the mesh.
void check_triangles_only(const std::string& path, std::string_view format, int dimension,
                          bool has_input_index) {
  if (dimension != 2) {
    throw UsageError(fmt::format(
        "cannot write {}: {} holds no tetrahedra; choose spm, ply, vtu or npy", path, format));
  }
  if (has_input_index) {
    throw UsageError(
        fmt::format("cannot write {}: {} holds no input index; choose spm, ply, vtu or npy, or "
                    "leave the index out",
                    path, format));
  }
}

bool needs_regular_file(MeshFormat format) {
  return format == MeshFormat::kGlb || format == MeshFormat::kStl || format == MeshFormat::kGpkg ||
         format == MeshFormat::kShp;
}

}  // namespace

std::vector<std::string> mesh_format_names() {
  std::vector<std::string> names;
  names.reserve(kFormats.size());
  for (const NamedFormat& known : kFormats) names.emplace_back(known.name);
  return names;
}

MeshFormat mesh_format(const std::string& path, const std::string& format_name) {
  if (path == "-" && format_name.empty()) return MeshFormat::kSpm;
  std::string name = format_name.empty() ? extension_of(path) : format_name;
  if (format_name.empty() && name == "xml") name = "landxml";
  const auto* const found =
      std::find_if(kFormats.begin(), kFormats.end(),
                   [&](const NamedFormat& known) { return known.name == name; });
  if (found != kFormats.end()) return found->format;
  const std::string what = !format_name.empty()
                               ? fmt::format("there is no mesh format \"{}\"", name)
                               : fmt::format("the name {} tells no mesh format", path);
  throw UsageError(fmt::format("{}; choose one of {}", what, fmt::join(mesh_format_names(), ", ")));
}

std::string rounding_note(MeshFormat format) {
  if (format != MeshFormat::kGlb && format != MeshFormat::kStl) return "";
  return fmt::format(
      "{} has 32-bit floats: coordinates are rounded, so info and check find another hash there",
      triangle_format(format));
}

MeshFiles create_mesh_files(FileSystem& files, const std::string& path, MeshFormat format,
                            int dimension, bool has_input_index) {
  MeshFiles created;
  created.format = format;
  if (const std::string_view name = triangle_format(format); !name.empty()) {
    check_triangles_only(path, name, dimension, has_input_index);
  }
  if (path == "-" && needs_regular_file(format)) {
    throw UsageError(
        fmt::format("standard output cannot take {}, whose begin is written last; name a "
                    "file",
                    triangle_format(format)));
  }
  if (format == MeshFormat::kGpkg || format == MeshFormat::kShp) return created;
  if (format == MeshFormat::kNpy) {
    const NpyMeshNames names = npy_mesh_to_write(files, path, has_input_index);
    created.main = files.create(names.vertices);
    created.simplices = files.create(names.simplices);
    if (has_input_index) created.input_index = files.create(names.input_index);
    return created;
  }
  created.main = files.create(path);
  return created;
}

std::unique_ptr<MeshWriter> open_mesh_writer(MeshFiles files, const MeshHeader& header) {
  switch (files.format) {
    case MeshFormat::kPly:
    case MeshFormat::kPlyAscii:
      return open_ply_writer(std::move(files.main), header, files.format == MeshFormat::kPlyAscii);
    case MeshFormat::kObj:
      return open_obj_writer(std::move(files.main), header);
    case MeshFormat::kOff:
      return open_off_writer(std::move(files.main), header);
    case MeshFormat::kVtu:
      return open_vtu_writer(std::move(files.main), header);
    case MeshFormat::kNpy:
      return open_npy_mesh_writer(std::move(files), header);
    case MeshFormat::kGlb:
      return open_glb_writer(std::move(files.main), header);
    case MeshFormat::kLandXml:
      return open_landxml_writer(std::move(files.main), header);
    default:
      throw Error("this mesh format is written block by block, not as a whole mesh");
  }
}

std::unique_ptr<MeshWriter> open_mesh_writer(FileSystem& files, const std::string& path,
                                             MeshFormat format, const MeshHeader& header) {
  return open_mesh_writer(
      create_mesh_files(files, path, format, header.dimension, header.has_input_index), header);
}

}  // namespace spillway::detail
