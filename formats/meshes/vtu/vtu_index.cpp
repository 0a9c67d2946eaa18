#include "formats/meshes/vtu/vtu_index.h"

#include <fmt/format.h>

#include <string_view>

#include "formats/bytes/bytes.h"
#include "formats/bytes/xml_scanner.h"
#include "formats/meshes/vtu/vtu_names.h"
#include "formats/meshes/vtu/vtu_point_arrays.h"
#include "src/error.h"

namespace spillway::formats {
namespace {

constexpr std::size_t kProbe = 1024;

}  // namespace

std::string pvtu_text(std::span<const std::string> names, const MeshStreamHeader& header) {
  const auto array = [](std::string_view type, std::string_view name, std::size_t components) {
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
  if (header.has_input_index) text += array("Int64", vtu::kInputIndex, 1);
  text += array("Int64", vtu::kGlobalIds, 1);
  for (const VtuPointArray& each : vtu_point_arrays(vtu_point_layout(header.attributes))) {
    text += array(each.type, each.name, each.components);
  }
  text += "    </PPointData>\n";
  if (header.periodic) {
    text += "    <PCellData>\n";
    text += array("Int8", vtu::kPeriodicOffsets,
                  static_cast<std::size_t>((header.dimension + 1) * header.dimension));
    text += "    </PCellData>\n";
  }
  for (const std::string& name : names) {
    text += fmt::format("    <Piece Source=\"{}\"/>\n", xml_escaped(name));
  }
  return text + "  </PUnstructuredGrid>\n</VTKFile>\n";
}

void check_is_no_pvtu(InputBytes& source) {
  if (as_text(source.peek(kProbe)).find("\"PUnstructuredGrid\"") == std::string_view::npos) return;
  throw BadInput(source.name(),
                 "this is the index of a mesh's parts, which is for viewers; name one of the "
                 "parts, or, to check the whole, write it to one file",
                 {}, Remedy::kOneFile);
}

}  // namespace spillway::formats
