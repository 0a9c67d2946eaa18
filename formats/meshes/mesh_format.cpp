#include "formats/meshes/mesh_format.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>

#include "formats/disk/extension.h"
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

}  // namespace

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
  throw InvalidArgument(
      fmt::format("{}; choose one of {}", what, fmt::join(mesh_format_names(), ", ")));
}

std::string rounding_note(MeshFormat format) {
  if (format != MeshFormat::kGlb && format != MeshFormat::kStl) return "";
  return fmt::format(
      "{} has 32-bit floats: coordinates are rounded, so info and check find another hash there",
      triangle_format(format));
}

}  // namespace spillway::detail
