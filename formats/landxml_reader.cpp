#include "formats/landxml_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <unordered_map>
#include <utility>

#include "formats/bytes.h"
#include "formats/fields.h"
#include "formats/landxml_names.h"
#include "formats/line_reader.h"
#include "formats/mesh_notes.h"
#include "formats/whole_file.h"
#include "formats/xml_scanner.h"
#include "src/error.h"

namespace spillway {
namespace {

/// Text with its entities replaced.
std::string unescaped(std::string_view text) {
  constexpr std::array<std::pair<std::string_view, char>, 5> kEntities = {
      {{"&amp;", '&'}, {"&lt;", '<'}, {"&gt;", '>'}, {"&quot;", '"'}, {"&apos;", '\''}}};
  std::string result;
  while (!text.empty()) {
    const auto* const entity =
        std::find_if(kEntities.begin(), kEntities.end(),
                     [&](const auto& known) { return text.starts_with(known.first); });
    const bool found = entity != kEntities.end();
    result += found ? entity->second : text.front();
    text.remove_prefix(found ? entity->first.size() : 1);
  }
  return result;
}

class LandXmlReader {
 public:
  LandXmlReader(std::string file, std::string_view text)
      : file_(std::move(file)), text_(text), scanner_(text) {}

  Mesh read() {
    for (XmlScanner::Result result = scanner_.next(tag_); result != XmlScanner::Result::kEnd;
         result = scanner_.next(tag_)) {
      if (result == XmlScanner::Result::kMalformed) fail("here is no XML tag");
      if (tag_.closing) {
        if (tag_.name == "Definition") within_tin_ = false;
        if (tag_.name == "LandXML") is_complete_ = true;
      } else {
        read_tag();
      }
    }
    if (!is_complete_) fail("the file ends before </LandXML>; get a complete copy");
    if (surfaces_ == 0) fail("there is no surface of surfType TIN");
    mesh_.header.vertices = mesh_.vertices.size();
    mesh_.header.simplices = mesh_.corners.size() / 3;
    return std::move(mesh_);
  }

 private:
  void read_tag() {
    if (tag_.name == "Definition") {
      within_tin_ = tag_.attribute("surfType") == "TIN";
      if (within_tin_ && ++surfaces_ > 1) {
        fail("there is a second TIN surface, but a mesh is one; copy it to a file of its own");
      }
    } else if (tag_.name == "CoordinateSystem") {
      read_crs();
    } else if (tag_.name == "Property" && tag_.attribute("label") == landxml::kNote) {
      if (!read_mesh_note(tag_.attribute("value"), mesh_.header)) {
        fail("the note on the lattice must give six numbers: three positive scales, three offsets");
      }
    } else if (within_tin_ && tag_.name == "P") {
      read_point();
    } else if (within_tin_ && tag_.name == "F") {
      read_face();
    }
  }

  void read_crs() {
    const std::string_view code = tag_.attribute(landxml::kEpsgCode);
    if (!code.empty()) {
      mesh_.header.crs = fmt::format("EPSG:{}", code);
    } else {
      mesh_.header.crs = unescaped(tag_.attribute(landxml::kWkt));
    }
  }

  /// What stands in the element, in one line.
  std::string_view content() {
    line_ = scanner_.content();
    std::replace_if(
        line_.begin(), line_.end(), [](char c) { return c == '\n' || c == '\r'; }, ' ');
    return line_;
  }

  void read_point() {
    const std::optional<std::uint64_t> id = parse_count(tag_.attribute("id"));
    if (!id) fail(fmt::format("the point's id {} is no number", quoted(tag_.attribute("id"))));
    if (!numbers_.emplace(*id, mesh_.vertices.size()).second) {
      fail(fmt::format("there is a second point {}", *id));
    }
    Fields fields(content());
    Point<3> northing_first;
    for (double& coordinate : northing_first) {
      const std::optional<double> number = fields.number();
      if (!number || !std::isfinite(*number)) {
        fail(fmt::format("point {} needs three finite numbers: northing, easting, elevation", *id));
      }
      coordinate = *number;
    }
    if (!fields.at_end()) fail(fmt::format("point {} has more than three numbers", *id));
    mesh_.vertices.push_back({northing_first[1], northing_first[0], northing_first[2]});
  }

  void read_face() {
    if (tag_.attribute("i") == "1") return;  // an invisible face: no part of the surface
    Fields fields(content());
    for (int k = 0; k < 3; ++k) {
      const std::optional<std::uint64_t> id = fields.count();
      const auto found = id ? numbers_.find(*id) : numbers_.end();
      if (found == numbers_.end()) fail("a face needs the ids of three points that stand before");
      mesh_.corners.push_back(found->second);
    }
    if (!fields.at_end()) fail("a face has more than three points; only triangles are read");
  }

  [[noreturn]] void fail(const std::string& what) const {
    const auto end = text_.begin() + static_cast<std::ptrdiff_t>(scanner_.position());
    throw Error(
        fmt::format("{}: line {}: {}", file_, 1 + std::count(text_.begin(), end, '\n'), what));
  }

  std::string file_;
  std::string_view text_;
  XmlScanner scanner_;
  XmlTag tag_;
  Mesh mesh_;
  std::unordered_map<std::uint64_t, std::uint64_t> numbers_;  // of vertices, by id
  std::string line_;
  int surfaces_ = 0;
  bool within_tin_ = false;
  bool is_complete_ = false;
};

}  // namespace

Mesh read_landxml(InputSource& source) {
  const std::vector<std::byte> bytes = read_whole(source);
  return LandXmlReader(source.name(), as_text(bytes)).read();
}

}  // namespace spillway
