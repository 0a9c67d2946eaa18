#include "formats/ply/ply_header.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>

#include "formats/bytes/bytes.h"
#include "formats/bytes/fields.h"
#include "formats/bytes/line_reader.h"
#include "formats/bytes/notes.h"
#include "src/error.h"

namespace spillway::formats {
namespace {

constexpr std::size_t kFirstPeek = std::size_t{1} << 12;
constexpr std::size_t kLongestHeader = std::size_t{1} << 22;

constexpr std::string_view kMagic = "ply";
constexpr std::string_view kLast = "end_header";

struct NamedType {
  std::string_view name;
  NumberType type;
};

constexpr std::array kTypes = {
    NamedType{"char", NumberType::kInt8},      NamedType{"int8", NumberType::kInt8},
    NamedType{"uchar", NumberType::kUint8},    NamedType{"uint8", NumberType::kUint8},
    NamedType{"short", NumberType::kInt16},    NamedType{"int16", NumberType::kInt16},
    NamedType{"ushort", NumberType::kUint16},  NamedType{"uint16", NumberType::kUint16},
    NamedType{"int", NumberType::kInt32},      NamedType{"int32", NumberType::kInt32},
    NamedType{"uint", NumberType::kUint32},    NamedType{"uint32", NumberType::kUint32},
    NamedType{"float", NumberType::kFloat32},  NamedType{"float32", NumberType::kFloat32},
    NamedType{"double", NumberType::kFloat64}, NamedType{"float64", NumberType::kFloat64}};

/// The header's bytes, the last line's end included.
std::string_view header_text(InputBytes& source) {
  const std::string last = fmt::format("\n{}", kLast);
  for (std::size_t wanted = kFirstPeek;; wanted *= 4) {
    const std::string_view text = as_text(source.peek(wanted));
    const std::size_t magic_end = text.find_first_of("\r\n");
    if (text.substr(0, magic_end) != kMagic) {
      throw BadInput(source.name(),
                     "this is not a PLY file: its first line is not \"ply\"; name its format",
                     at_line(1));
    }
    for (std::size_t at = text.find(last); at != text.npos; at = text.find(last, at + 1)) {
      const std::size_t end = at + last.size();
      if (text.substr(end).starts_with('\n')) return text.substr(0, end + 1);
      if (text.substr(end).starts_with("\r\n")) return text.substr(0, end + 2);
    }
    if (text.size() < wanted || wanted >= kLongestHeader) {
      throw BadInput(source.name(),
                     fmt::format("the header has no line \"{}\" in its first {} bytes; get a "
                                 "complete copy",
                                 kLast, text.size()),
                     at_byte(text.size()));
    }
  }
}

/// Programs write X and x.
std::string in_lower_case(std::string_view name) {
  std::string lower(name);
  std::ranges::transform(lower, lower.begin(), [](unsigned char c) { return std::tolower(c); });
  return lower;
}

class HeaderParser {
 public:
  explicit HeaderParser(const std::string& file) : file_(file) {}

  PlyHeader parse(std::string_view text) {
    while (!text.empty()) {
      const std::size_t end = text.find('\n');
      std::string_view line = text.substr(0, end);
      text.remove_prefix(end + 1);
      if (line.ends_with('\r')) line.remove_suffix(1);
      ++header_.lines;
      if (header_.lines > 1 && line != kLast) parse_line(line);
    }
    if (!has_format_) fail("there is no line \"format ... 1.0\" before it");
    return std::move(header_);
  }

 private:
  void parse_line(std::string_view line) {
    constexpr std::string_view kComment = "comment ";
    if (line.starts_with(kComment)) {
      const std::string_view comment = line.substr(kComment.size());
      header_.comments.push_back({std::string(comment), header_.lines});
      header_.by_spillway |= is_spillway_note(comment);
      return;
    }
    Fields fields(line);
    const std::string_view keyword = fields.word();
    if (keyword == "format") {
      parse_format(fields);
    } else if (keyword == "element") {
      parse_element(fields);
    } else if (keyword == "property") {
      parse_property(fields);
    } else if (keyword != "comment" && keyword != "obj_info") {
      fail(fmt::format("{} is not a keyword of a PLY header", quoted(keyword)));
    }
  }

  void parse_format(Fields& fields) {
    const std::string_view encoding = fields.word();
    if (encoding == "ascii") {
      header_.encoding = PlyEncoding::kAscii;
    } else if (encoding == "binary_little_endian") {
      header_.encoding = PlyEncoding::kLittleEndian;
    } else if (encoding == "binary_big_endian") {
      header_.encoding = PlyEncoding::kBigEndian;
    } else {
      fail(fmt::format("there is no PLY format {}", quoted(encoding)));
    }
    const std::string_view version = fields.word();
    if (version != "1.0") fail(fmt::format("PLY {} is not read, only 1.0", quoted(version)));
    if (has_format_) fail("the format is given a second time");
    has_format_ = true;
  }

  void parse_element(Fields& fields) {
    PlyElement element;
    element.name = fields.word();
    const std::optional<std::uint64_t> count = fields.count();
    if (element.name.empty() || !count || !fields.at_end()) {
      fail("an element is given as \"element NAME COUNT\"");
    }
    element.count = *count;
    if (header_.find(element.name) != nullptr) {
      fail(fmt::format("the element {} is given a second time", quoted(element.name)));
    }
    header_.elements.push_back(std::move(element));
  }

  void parse_property(Fields& fields) {
    if (header_.elements.empty()) fail("a property comes before the first element");
    PlyElement& element = header_.elements.back();
    PlyProperty property;
    std::string_view type = fields.word();
    if (type == "list") {
      property.length_type = type_called(fields.word());
      if (!is_integer(*property.length_type)) fail("the length of a list must be an integer");
      type = fields.word();
    }
    property.type = type_called(type);
    property.written = fields.word();
    property.name = in_lower_case(property.written);
    if (property.name.empty() || !fields.at_end()) {
      fail("a property is given as \"property TYPE NAME\" or \"property list TYPE TYPE NAME\"");
    }
    if (element.find(property.name) >= 0) {
      fail(fmt::format("the property {} is given a second time", quoted(property.name)));
    }
    element.properties.push_back(std::move(property));
  }

  [[nodiscard]] NumberType type_called(std::string_view name) const {
    const auto* const found = std::find_if(kTypes.begin(), kTypes.end(),
                                           [&](const NamedType& t) { return t.name == name; });
    if (found == kTypes.end()) fail(fmt::format("there is no PLY type {}", quoted(name)));
    return found->type;
  }

  [[noreturn]] void fail(const std::string& what) const {
    throw BadInput::at(file_, at_line(header_.lines),
                       fmt::format("{}; the header is corrupt", what));
  }

  const std::string& file_;
  PlyHeader header_;
  bool has_format_ = false;
};

}  // namespace

int PlyElement::find(std::string_view property) const {
  for (std::size_t i = 0; i < properties.size(); ++i) {
    if (properties[i].name == property) return static_cast<int>(i);
  }
  return -1;
}

const PlyElement* PlyHeader::find(std::string_view element) const {
  const auto found = std::find_if(elements.begin(), elements.end(),
                                  [&](const PlyElement& e) { return e.name == element; });
  return found == elements.end() ? nullptr : &*found;
}

const PlyElement* PlyHeader::simplices() const {
  const PlyElement* const faces = find(kPlyFace);
  const PlyElement* const tetrahedra = find(kPlyTetrahedron);
  for (const PlyElement* const element : {tetrahedra, faces}) {
    if (element != nullptr && element->count > 0) return element;
  }
  if (!by_spillway) return nullptr;
  return tetrahedra != nullptr ? tetrahedra : faces;
}

bool begins_as_ply(std::string_view first_bytes) { return begins_with_word(first_bytes, kMagic); }

std::optional<std::string_view> ply_type(NumberType type) {
  const auto* const found = std::ranges::find(kTypes, type, &NamedType::type);
  if (found == kTypes.end()) return std::nullopt;
  return found->name;
}

PlyHeader peek_ply_header(InputBytes& source) {
  return HeaderParser(source.name()).parse(header_text(source));
}

PlyHeader read_ply_header(InputBytes& source) {
  const std::string_view text = header_text(source);
  PlyHeader header = HeaderParser(source.name()).parse(text);
  source.skip(text.size());
  return header;
}

}  // namespace spillway::formats
