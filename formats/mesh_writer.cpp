#include "formats/mesh_writer.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <utility>

#include "formats/npy_mesh.h"
#include "formats/obj_writer.h"
#include "formats/off_writer.h"
#include "formats/ply_writer.h"
#include "formats/point_format.h"
#include "formats/vtu_writer.h"
#include "src/error.h"

namespace spillway {
namespace {

struct NamedFormat {
  std::string_view name;
  MeshFormat format;
};

constexpr std::array kFormats = {
    NamedFormat{"ply", MeshFormat::kPly}, NamedFormat{"ply-ascii", MeshFormat::kPlyAscii},
    NamedFormat{"obj", MeshFormat::kObj}, NamedFormat{"off", MeshFormat::kOff},
    NamedFormat{"vtu", MeshFormat::kVtu}, NamedFormat{"npy", MeshFormat::kNpy}};

/// Throws Error if the format, of triangles only, cannot hold the mesh.
void check_triangles_only(const std::string& path, std::string_view format,
                          const MeshHeader& header) {
  if (header.dimension != 2) {
    throw Error(fmt::format("cannot write {}: {} holds no tetrahedra; choose ply, vtu or npy", path,
                            format));
  }
  if (header.has_input_index) {
    throw Error(
        fmt::format("cannot write {}: {} holds no input index; choose ply, vtu or npy, or "
                    "leave the index out",
                    path, format));
  }
}

}  // namespace

std::vector<std::string> mesh_format_names() {
  std::vector<std::string> names;
  names.reserve(kFormats.size());
  for (const NamedFormat& known : kFormats) names.emplace_back(known.name);
  return names;
}

MeshFormat mesh_format(const std::string& path, const std::string& format_name) {
  const std::string name = format_name.empty() ? extension_of(path) : format_name;
  const auto* const found =
      std::find_if(kFormats.begin(), kFormats.end(),
                   [&](const NamedFormat& known) { return known.name == name; });
  if (found != kFormats.end()) return found->format;
  const std::string what = !format_name.empty()
                               ? fmt::format("there is no mesh format \"{}\"", name)
                           : path == "-" ? "standard output has no extension"
                                         : fmt::format("the name {} tells no mesh format", path);
  throw UsageError(fmt::format("{}; choose one of {}", what, fmt::join(mesh_format_names(), ", ")));
}

std::unique_ptr<MeshWriter> open_mesh_writer(FileSystem& files, const std::string& path,
                                             MeshFormat format, const MeshHeader& header) {
  switch (format) {
    case MeshFormat::kPly:
    case MeshFormat::kPlyAscii:
      return open_ply_writer(files.create(path), header, format == MeshFormat::kPlyAscii);
    case MeshFormat::kObj:
      check_triangles_only(path, "OBJ", header);
      return open_obj_writer(files.create(path), header);
    case MeshFormat::kOff:
      check_triangles_only(path, "OFF", header);
      return open_off_writer(files.create(path), header);
    case MeshFormat::kVtu:
      return open_vtu_writer(files.create(path), header);
    case MeshFormat::kNpy:
      break;
  }
  return open_npy_mesh_writer(files, path, header);
}

}  // namespace spillway
