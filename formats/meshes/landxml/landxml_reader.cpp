#include "formats/meshes/landxml/landxml_reader.h"

#include <fmt/format.h>

#include <cmath>
#include <cstddef>
#include <span>
#include <string>
#include <unordered_map>
#include <utility>

#include "formats/bytes/fields.h"
#include "formats/bytes/line_reader.h"
#include "formats/bytes/xml_scanner.h"
#include "formats/meshes/common/mesh_notes.h"
#include "formats/meshes/landxml/landxml_names.h"
#include "src/error.h"

namespace spillway::formats {
namespace {

/// Goes through the tags of a file of any size, a window of which is in memory.
class XmlTags {
 public:
  explicit XmlTags(InputBytes& source) : source_(source) {}

  /// Goes to the next tag; false at the end. Throws Failure for what is no XML.
  bool next(XmlTag& tag) {
    while (true) {
      const std::size_t before = scanner_.position();
      const XmlScanner::Result result = scanner_.next(tag);
      const bool whole = result == XmlScanner::Result::kTag && scanner_.has_content_end();
      if (whole || (ended_ && result == XmlScanner::Result::kTag)) return true;
      if (ended_ && result == XmlScanner::Result::kEnd) return false;
      if (ended_) fail("an XML tag is expected here");
      read_on(before);
    }
  }

  /// What stands between the tag that next() gave last and the one after it.
  [[nodiscard]] std::string_view content() const { return scanner_.content(); }

  [[noreturn]] void fail(const std::string& what) const {
    const std::string_view passed = std::string_view(window_).substr(0, scanner_.position());
    const auto line = lines_before_ + std::count(passed.begin(), passed.end(), '\n');
    throw BadInput::at(source_.name(), at_line(line), what);
  }

 private:
  static constexpr std::size_t kStep = std::size_t{1} << 20;
  static constexpr std::size_t kLongestElement = std::size_t{16} << 20;

  /// Drops what is before that place in the window and reads more after it.
  void read_on(std::size_t begin) {
    const auto first = window_.begin();
    lines_before_ += std::count(first, first + static_cast<std::ptrdiff_t>(begin), '\n');
    window_.erase(0, begin);
    scanner_ = XmlScanner(window_);
    if (window_.size() >= kLongestElement) {
      fail(fmt::format("no XML tag begins and ends within {} bytes from here", kLongestElement));
    }
    const std::size_t had = window_.size();
    window_.resize(had + kStep);
    const std::size_t got = source_.read(std::as_writable_bytes(std::span(window_).subspan(had)));
    window_.resize(had + got);
    ended_ = got < kStep;
    scanner_ = XmlScanner(window_);
    if (!looks_like_text(std::string_view(window_).substr(had))) {
      fail(
          "after this line comes a control character, which XML cannot have; the file is corrupt "
          "or has another format");
    }
  }

  InputBytes& source_;
  std::string window_;
  XmlScanner scanner_{std::string_view()};
  bool ended_ = false;               // the window reaches to the end of the file
  std::ptrdiff_t lines_before_ = 1;  // number of the line in which the window begins
};

class LandXmlReader {
 public:
  explicit LandXmlReader(InputBytes& source) : tags_(source) {}

  Mesh read() {
    while (tags_.next(tag_)) {
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
      mesh_.header.crs = xml_unescaped(tag_.attribute(landxml::kWkt));
    }
  }

  /// What stands in the element, in one line.
  std::string_view content() {
    line_ = tags_.content();
    std::replace_if(
        line_.begin(), line_.end(), [](char c) { return c == '\n' || c == '\r'; }, ' ');
    return line_;
  }

  void read_point() {
    const std::optional<std::uint64_t> id = parse_count(tag_.attribute("id"));
    if (!id) fail(fmt::format("the point's id {} is not a number", quoted(tag_.attribute("id"))));
    if (!numbers_.emplace(*id, mesh_.vertices.size()).second) {
      fail(fmt::format("there is a second point {}", *id));
    }
    Fields fields(content());
    WorldPoint northing_first;
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
      if (found == numbers_.end()) fail("a face needs the ids of three points that come before it");
      mesh_.corners.push_back(found->second);
    }
    if (!fields.at_end()) fail("a face has more than three points; only triangles are read");
  }

  [[noreturn]] void fail(const std::string& what) const { tags_.fail(what); }

  XmlTags tags_;
  XmlTag tag_;
  Mesh mesh_;
  std::unordered_map<std::uint64_t, std::uint64_t> numbers_;  // of vertices, by id
  std::string line_;
  int surfaces_ = 0;
  bool within_tin_ = false;
  bool is_complete_ = false;
};

}  // namespace

Mesh read_landxml(InputBytes& source) { return LandXmlReader(source).read(); }

}  // namespace spillway::formats
