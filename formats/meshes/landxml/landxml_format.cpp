#include "formats/meshes/landxml/landxml_format.h"

#include <cstdint>
#include <utility>

#include "formats/meshes/landxml/landxml_reader.h"
#include "formats/meshes/landxml/landxml_writer.h"

namespace spillway::formats {
namespace {

constexpr std::string_view kExtensions[] = {"landxml", "xml"};

}  // namespace

constinit const MeshFormat kLandXmlMesh = {
    .name = "landxml",
    .title = "LandXML",
    .extensions = kExtensions,
    .name_tells = false,
    .reads_crs = true,
    .recognises = [](std::string_view text) { return text.find("<LandXML") != text.npos; },
    .read = [](InputBytes& source, std::uint64_t) { return read_landxml(source); },
    .open_writer =
        [](MeshFiles files, const MeshFileHeader& header) {
          return open_landxml_writer(std::move(files.main), header);
        },
};

}  // namespace spillway::formats
