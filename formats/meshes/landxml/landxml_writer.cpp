#include "formats/meshes/landxml/landxml_writer.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <string>
#include <utility>

#include "formats/bytes/buffered_output.h"
#include "formats/bytes/xml_scanner.h"
#include "formats/gdal/gdal.h"
#include "formats/meshes/common/checked_mesh_writer.h"
#include "formats/meshes/common/mesh_notes.h"
#include "formats/meshes/common/mesh_text.h"
#include "formats/meshes/landxml/landxml_names.h"

namespace spillway::formats {
namespace {

constexpr double kFoot = 0.3048;
constexpr double kSurveyFoot = 1200.0 / 3937;
constexpr std::string_view kEpsg = "EPSG:";

bool is_epsg_code(std::string_view crs) {
  if (!crs.starts_with(kEpsg) || crs.size() == kEpsg.size()) return false;
  crs.remove_prefix(kEpsg.size());
  return std::all_of(crs.begin(), crs.end(), [](char c) { return c >= '0' && c <= '9'; });
}

/// The element Units, which LandXML demands: metres unless the system says feet.
std::string units(const std::string& crs) {
  const double unit = crs.empty() ? 1 : gdal().crs_unit(crs);
  const auto is = [&](double metres) { return std::abs(unit - metres) < 1e-9; };
  if (is(kFoot) || is(kSurveyFoot)) {
    return fmt::format(
        "<Imperial areaUnit=\"squareFoot\" linearUnit=\"{}\" volumeUnit=\"cubicFeet\" "
        "temperatureUnit=\"fahrenheit\" pressureUnit=\"inHG\"/>",
        is(kFoot) ? "foot" : "USSurveyFoot");
  }
  return "<Metric areaUnit=\"squareMeter\" linearUnit=\"meter\" volumeUnit=\"cubicMeter\" "
         "temperatureUnit=\"celsius\" pressureUnit=\"HPA\"/>";
}

std::string coordinate_system(const std::string& crs) {
  if (crs.empty()) return "";
  if (is_epsg_code(crs)) {
    return fmt::format("  <CoordinateSystem {}=\"{}\"/>\n", landxml::kEpsgCode,
                       std::string_view(crs).substr(kEpsg.size()));
  }
  return fmt::format("  <CoordinateSystem {}=\"{}\"/>\n", landxml::kWkt,
                     xml_escaped(one_line(crs)));
}

class LandXmlWriter : public CheckedMeshWriter {
 public:
  LandXmlWriter(std::unique_ptr<OutputFile> file, const MeshFileHeader& mesh)
      : CheckedMeshWriter(mesh, file->name()), output_(std::move(file)) {
    // The date is demanded, but equal meshes shall give equal files.
    output_.append(
        fmt::format("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
                    "<LandXML xmlns=\"http://www.landxml.org/schema/LandXML-1.2\" version=\"1.2\" "
                    "date=\"1970-01-01\" time=\"00:00:00\">\n"
                    "  <Units>{}</Units>\n{}"
                    "  <Application name=\"Spillway\"/>\n"
                    "  <Surfaces>\n    <Surface name=\"{}\">\n"
                    "      <Definition surfType=\"TIN\">\n<Pnts>\n",
                    units(mesh.crs), coordinate_system(mesh.crs),
                    xml_escaped(std::filesystem::path(output_.name()).stem().string())));
  }

 private:
  void put_vertices(std::span<const WorldPoint> vertices,
                    std::span<const std::uint64_t> /*input_index*/,
                    std::span<const std::byte> /*attributes*/) override {
    for (const WorldPoint& vertex : vertices) {
      append_number(output_, "<P id=\"", ++points_);
      append_coordinates(output_, "\">", {vertex[1], vertex[0], vertex[2]});
      output_.append("</P>\n");
    }
  }

  void put_simplices(std::span<const std::uint64_t> corners) override {
    begin_faces();
    for (; !corners.empty(); corners = corners.subspan(3)) {
      append_number(output_, "<F>", corners[0] + 1);
      append_number(output_, " ", corners[1] + 1);
      append_number(output_, " ", corners[2] + 1);
      output_.append("</F>\n");
    }
  }

  void complete() override {
    begin_faces();
    output_.append("</Faces>\n      </Definition>\n");
    output_.append(fmt::format("      <Feature name=\"{}\">\n", landxml::kNotes));
    MeshFileHeader notes = header();
    notes.crs.clear();
    for (const std::string& note : mesh_notes(notes)) {
      output_.append(
          fmt::format("        <Property label=\"{}\" value=\"{}\"/>\n", landxml::kNote, note));
    }
    output_.append("      </Feature>\n    </Surface>\n  </Surfaces>\n</LandXML>\n");
    output_.commit();
  }

  void begin_faces() {
    if (!std::exchange(has_faces_, true)) output_.append("</Pnts>\n<Faces>\n");
  }

  BufferedOutput output_;
  std::uint64_t points_ = 0;  // written so far
  bool has_faces_ = false;    // the element Faces has begun
};

}  // namespace

std::unique_ptr<MeshWriter> open_landxml_writer(std::unique_ptr<OutputFile> file,
                                                const MeshFileHeader& header) {
  return std::make_unique<LandXmlWriter>(std::move(file), header);
}

}  // namespace spillway::formats
