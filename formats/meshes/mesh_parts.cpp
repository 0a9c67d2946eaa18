#include "formats/meshes/mesh_parts.h"

#include <fmt/format.h>

#include <filesystem>

#include "formats/bytes/xml_scanner.h"
#include "formats/disk/extension.h"
#include "formats/meshes/mesh_format.h"
#include "formats/meshes/vtu/vtu_names.h"
#include "formats/points/point_format.h"

namespace spillway::detail {
namespace {

std::string extension_of_format(MeshFormat format) {
  return mesh_format_names().at(static_cast<std::size_t>(format));
}

/// Without the extension, if it is the format's own or the index's.
std::string stem_of(const std::string& path, MeshFormat format) {
  const std::string extension = extension_of(path);
  const bool known = extension == extension_of_format(format) ||
                     (format == MeshFormat::kVtu && extension == kPvtu);
  return known ? path.substr(0, path.size() - extension.size() - 1) : path;
}

}  // namespace

std::string mesh_part_name(const std::string& path, MeshFormat format, int part, int parts) {
  const std::size_t digits = fmt::formatted_size("{}", parts - 1);
  return fmt::format("{}.{:0{}}.{}", stem_of(path, format), part, digits,
                     extension_of_format(format));
}

std::string pvtu_name(const std::string& path) {
  return fmt::format("{}.{}", stem_of(path, MeshFormat::kVtu), kPvtu);
}

std::string pvtu_text(const std::string& path, int parts, bool has_input_index) {
  const auto array = [](std::string_view type, std::string_view name, int components) {
    return fmt::format(R"(      <PDataArray type="{}" Name="{}" NumberOfComponents="{}"/>)"
                       "\n",
                       type, name, components);
  };
  std::string text =
      R"(<?xml version="1.0"?>
<VTKFile type="PUnstructuredGrid" version="1.0" byte_order="LittleEndian" header_type="UInt64">
  <PUnstructuredGrid GhostLevel="0">
    <PPoints>
)";
  text += array("Float64", "Points", 3);
  text += fmt::format("    </PPoints>\n    <PPointData GlobalIds=\"{}\">\n", vtu::kGlobalIds);
  if (has_input_index) text += array("Int64", vtu::kInputIndex, 1);
  text += array("Int64", vtu::kGlobalIds, 1);
  text += "    </PPointData>\n";
  for (int part = 0; part < parts; ++part) {
    const std::filesystem::path name = mesh_part_name(path, MeshFormat::kVtu, part, parts);
    text += fmt::format("    <Piece Source=\"{}\"/>\n", xml_escaped(name.filename().string()));
  }
  return text + "  </PUnstructuredGrid>\n</VTKFile>\n";
}

}  // namespace spillway::detail
