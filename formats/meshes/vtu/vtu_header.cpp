#include "formats/meshes/vtu/vtu_header.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>
#include <vector>

#include "formats/bytes/bytes.h"
#include "formats/bytes/fields.h"
#include "formats/bytes/line_reader.h"
#include "formats/bytes/xml_scanner.h"
#include "formats/meshes/common/mesh_notes.h"
#include "formats/meshes/vtu/vtu_names.h"
#include "src/error.h"

namespace spillway::detail {
namespace {

constexpr std::size_t kFirstPeek = std::size_t{1} << 13;
constexpr std::size_t kLongestHeader = std::size_t{1} << 24;

struct NamedType {
  std::string_view name;
  NumberType type;
};

constexpr std::array kTypes = {
    NamedType{"Int8", NumberType::kInt8},       NamedType{"UInt8", NumberType::kUint8},
    NamedType{"Int16", NumberType::kInt16},     NamedType{"UInt16", NumberType::kUint16},
    NamedType{"Int32", NumberType::kInt32},     NamedType{"UInt32", NumberType::kUint32},
    NamedType{"Int64", NumberType::kInt64},     NamedType{"UInt64", NumberType::kUint64},
    NamedType{"Float32", NumberType::kFloat32}, NamedType{"Float64", NumberType::kFloat64}};

/// The header's text, up to and with the underscore that precedes the appended data; all of a file
/// that has none.
std::string_view header_text(InputBytes& source) {
  for (std::size_t wanted = kFirstPeek;; wanted *= 4) {
    const std::string_view text = as_text(source.peek(wanted));
    const std::size_t appended = text.find("<AppendedData");
    const std::size_t bracket = text.find('>', appended);
    if (bracket != text.npos) {
      const std::size_t data = text.find_first_not_of(" \t\r\n", bracket + 1);
      if (data != text.npos && text[data] != '_') {
        throw BadInput::at(source.name(), at_byte(data),
                           "appended data begins without an underscore; the file is corrupt");
      }
      if (data != text.npos) return text.substr(0, data + 1);
    }
    if (text.size() < wanted || wanted >= kLongestHeader) {
      if (bracket == text.npos) return text;
      throw BadInput(source.name(),
                     fmt::format("the file ends at byte {}, before its appended data; get a "
                                 "complete copy",
                                 text.size()),
                     at_byte(text.size()));
    }
  }
}

class HeaderParser {
 public:
  HeaderParser(const std::string& file, std::string_view text) : file_(file), scanner_(text) {
    header_.mesh.dimension = 0;
  }

  VtuHeader parse() {
    for (XmlScanner::Result result = scanner_.next(tag_); result != XmlScanner::Result::kEnd;
         result = scanner_.next(tag_)) {
      if (result == XmlScanner::Result::kMalformed) fail("an XML tag is expected here");
      if (tag_.closing) continue;
      read_tag();
      if (tag_.name == "AppendedData") return finish();
    }
    fail("there is no AppendedData; only VTU with appended raw data is read");
  }

 private:
  void read_tag() {
    const std::string_view name = tag_.name;
    if (name == "VTKFile") {
      has_file_ = true;
      check_kind();
    } else if (name == "Piece") {
      if (has_piece_) fail("there is a second Piece; merge the pieces into one");
      has_piece_ = true;
      header_.mesh.vertices = count_attribute("NumberOfPoints");
      header_.mesh.simplices = count_attribute("NumberOfCells");
    } else if (name == "DataArray") {
      read_array();
    } else if (name == "AppendedData") {
      expect("encoding", "raw");
    } else if (name == "FieldData" || name == "Points" || name == "PointData" || name == "Cells" ||
               name == "CellData") {
      section_ = name;
    }
  }

  void check_kind() const {
    expect("type", "UnstructuredGrid");
    expect("byte_order", "LittleEndian");
    expect("header_type", "UInt64");
    expect("compressor", "");
  }

  void read_array() {
    const std::string_view name = tag_.attribute("Name");
    if (section_ == "FieldData") {
      read_field(name);
    } else if (section_ == "Points") {
      add("Points");
    } else if (section_ == "Cells") {
      add(std::string(name));
    } else if (section_ == "PointData" && name == vtu::kInputIndex) {
      add(vtu::kInputIndex);
    }
  }

  void add(const std::string& name) {
    expect("format", "appended");
    VtuArray array;
    array.type = type();
    array.offset = count_attribute("offset");
    if (!tag_.attribute("NumberOfComponents").empty()) {
      array.components = count_attribute("NumberOfComponents");
    }
    const std::uint64_t components = name == "Points" ? 3 : 1;
    if (array.components != components) {
      fail(fmt::format("the array {} needs {} components", name, components));
    }
    if (!arrays_.emplace(name, array).second) fail(fmt::format("there is a second {}", name));
  }

  [[nodiscard]] NumberType type() const {
    const std::string_view name = tag_.attribute("type");
    const auto* const found = std::find_if(kTypes.begin(), kTypes.end(),
                                           [&](const NamedType& t) { return t.name == name; });
    if (found == kTypes.end()) fail(fmt::format("there is no VTK type {}", quoted(name)));
    return found->type;
  }

  void read_field(std::string_view name) {
    if (name == vtu::kDimension) {
      const std::vector<double> numbers = inline_numbers();
      if (numbers.size() != 1 || (numbers[0] != 2 && numbers[0] != 3)) {
        fail(fmt::format("{} must be 2 or 3", name));
      }
      header_.mesh.dimension = static_cast<int>(numbers[0]);
    } else if (name == vtu::kLattice) {
      header_.mesh.lattice = lattice_of(inline_numbers());
      if (!header_.mesh.lattice) {
        fail(fmt::format("{} must be six numbers: three positive scales, three offsets", name));
      }
    } else if (name == vtu::kCrs) {
      header_.mesh.crs.clear();
      for (const double code : inline_numbers()) {
        if (!(code >= 1 && code <= 255)) fail(fmt::format("{} must be bytes of text", name));
        header_.mesh.crs += static_cast<char>(static_cast<unsigned char>(code));
      }
    }
  }

  /// The numbers between the array's tags.
  [[nodiscard]] std::vector<double> inline_numbers() const {
    expect("format", "ascii");
    std::string text(scanner_.content());
    std::replace_if(
        text.begin(), text.end(), [](char c) { return c == '\n' || c == '\r'; }, ' ');
    Fields fields(text);
    std::vector<double> numbers;
    while (!fields.at_end()) {
      const std::optional<double> number = fields.number();
      if (!number) fail("the array holds something that is not a number");
      numbers.push_back(*number);
    }
    return numbers;
  }

  VtuHeader finish() {
    if (!has_file_ || !has_piece_) fail("VTKFile or Piece is missing before AppendedData");
    header_.points = array("Points");
    header_.connectivity = array("connectivity");
    header_.offsets = array("offsets");
    header_.types = array("types");
    for (const char* name : {"connectivity", "offsets", "types"}) {
      if (!is_integer(array(name).type)) fail(fmt::format("{} must be integers", name));
    }
    if (arrays_.contains(vtu::kInputIndex)) header_.input_index = array(vtu::kInputIndex);
    header_.mesh.has_input_index = header_.input_index.has_value();
    return header_;
  }

  [[nodiscard]] const VtuArray& array(const std::string& name) const {
    const auto found = arrays_.find(name);
    if (found == arrays_.end()) fail(fmt::format("the array {} is missing", name));
    return found->second;
  }

  [[nodiscard]] std::uint64_t count_attribute(std::string_view key) const {
    const std::optional<std::uint64_t> count = parse_count(tag_.attribute(key));
    if (!count) fail(fmt::format("{} has no number {}", tag_.name, key));
    return *count;
  }

  void expect(std::string_view key, std::string_view value) const {
    const std::string_view found = tag_.attribute(key);
    if (found == value) return;
    fail(
        fmt::format("{} has {}={}, but only {} is read; save the mesh with appended raw data, "
                    "UInt64 headers, little-endian, uncompressed",
                    tag_.name, key, quoted(found), quoted(value)));
  }

  [[noreturn]] void fail(const std::string& what) const {
    throw BadInput::at(file_, at_byte(scanner_.position()), what);
  }

  const std::string& file_;
  XmlScanner scanner_;
  XmlTag tag_;
  std::string_view section_;  // the element that the arrays are in
  bool has_file_ = false;
  bool has_piece_ = false;
  std::map<std::string, VtuArray> arrays_;
  VtuHeader header_;
};

}  // namespace

VtuHeader read_vtu_header(InputBytes& source) {
  const std::string_view text = header_text(source);
  VtuHeader header = HeaderParser(source.name(), text).parse();
  source.skip(text.size());
  return header;
}

}  // namespace spillway::detail
