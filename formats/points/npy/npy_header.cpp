#include "formats/points/npy/npy_header.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>

#include "formats/bytes/bytes.h"
#include "formats/points/npy/npy_types.h"
#include "src/error.h"

namespace spillway::formats {
namespace {

constexpr std::size_t kLongestDictionary = 65536;
constexpr std::size_t kAlignment = 64;
constexpr std::size_t kMostDimensions = 32;
constexpr int kMostStructures = 16;                           ///< one within another
constexpr std::uint64_t kMostBytes = std::uint64_t{1} << 32;  ///< of a field
constexpr const char* kStructure = "structure";

[[noreturn]] void fail(const InputBytes& source, std::uint64_t byte, const std::string& what) {
  throw BadInput(source.name(), what, at_byte(byte));
}

/// Parses the Python dictionary that describes the array; `ok` turns false at what it cannot be.
class DictionaryParser {
 public:
  explicit DictionaryParser(std::string_view text) : rest_(text) {}

  /// The described array, or nothing if the text is no such dictionary.
  std::optional<NpyHeader> parse() {
    NpyHeader header;
    bool has_type = false;
    bool has_order = false;
    bool has_shape = false;
    if (!accept("{")) return std::nullopt;
    while (!accept("}")) {
      const std::optional<std::string> key = string();
      if (!key || !accept(":")) return std::nullopt;
      bool valid = false;
      if (*key == "descr") {
        valid = has_type = type_or_fields(header);
      } else if (*key == "fortran_order") {
        header.fortran_order = accept("True");
        valid = has_order = header.fortran_order || accept("False");
      } else if (*key == "shape") {
        valid = has_shape = tuple(header.shape);
      }
      if (!valid) return std::nullopt;
      if (!accept(",")) {
        if (!accept("}")) return std::nullopt;
        break;
      }
    }
    if (!has_type || !has_order || !has_shape) return std::nullopt;
    return header;
  }

 private:
  void skip_blanks() {
    rest_.remove_prefix(std::min(rest_.find_first_not_of(" \n"), rest_.size()));
  }

  bool accept(std::string_view token) {
    skip_blanks();
    if (!rest_.starts_with(token)) return false;
    rest_.remove_prefix(token.size());
    return true;
  }

  /// A backslash stands before quotes and backslashes of the string.
  std::optional<std::string> string() {
    skip_blanks();
    if (rest_.empty() || (rest_[0] != '\'' && rest_[0] != '"')) return std::nullopt;
    const char quote = rest_[0];
    std::string result;
    for (std::size_t i = 1; i < rest_.size(); ++i) {
      if (rest_[i] == quote) {
        rest_.remove_prefix(i + 1);
        return result;
      }
      const std::string_view next = rest_.substr(i + 1, 1);
      if (rest_[i] == '\\' && (next == "'" || next == "\"" || next == "\\")) ++i;
      result.push_back(rest_[i]);
    }
    return std::nullopt;
  }

  bool type_or_fields(NpyHeader& header) {
    if (accept("[")) {
      header.type = kStructure;
      return fields(header.fields, 0);
    }
    const std::optional<std::string> type = string();
    if (type) header.type = *type;
    return type.has_value();
  }

  /// The rest of a list of fields.
  bool fields(std::vector<NpyField>& all, int depth) {
    if (depth == kMostStructures) return false;
    while (!accept("]")) {
      if (!field(all.emplace_back(), depth)) return false;
      if (!accept(",")) return accept("]") && !all.empty();
    }
    return !all.empty();
  }

  /// (name, type) or (name, type, shape).
  bool field(NpyField& field, int depth) {
    if (!accept("(") || !name(field.name) || !accept(",")) return false;
    std::optional<std::uint64_t> size;
    if (accept("[")) {
      std::vector<NpyField> inner;
      if (!fields(inner, depth + 1)) return false;
      field.type = kStructure;
      size = size_of_all(inner);
    } else {
      const std::optional<std::string> type = string();
      if (!type) return false;
      field.type = *type;
      size = npy_size(*type);
    }
    std::vector<std::uint64_t> shape;
    if (accept(",") && !tuple(shape)) return false;
    for (const std::uint64_t length : shape) {
      if (length > 0 && field.elements > kMostBytes / length) return false;
      field.elements *= length;
    }
    if (!accept(")")) return false;
    field.is_size_known = size.has_value();
    if (field.elements > 0 && size.value_or(0) > kMostBytes / field.elements) return false;
    field.size = size.value_or(0) * field.elements;
    return true;
  }

  /// A name, or a title and a name.
  bool name(std::string& out) {
    const bool has_title = accept("(");
    if (has_title && (!string() || !accept(","))) return false;
    const std::optional<std::string> name = string();
    if (name) out = *name;
    return name.has_value() && (!has_title || accept(")"));
  }

  /// Bytes of all fields; nothing if one does not tell.
  static std::optional<std::uint64_t> size_of_all(const std::vector<NpyField>& fields) {
    std::uint64_t sum = 0;
    for (const NpyField& field : fields) {
      if (!field.is_size_known) return std::nullopt;
      sum += field.size;
    }
    return sum;
  }

  bool tuple(std::vector<std::uint64_t>& lengths) {
    if (!accept("(")) return false;
    lengths.clear();
    while (!accept(")")) {
      skip_blanks();
      std::uint64_t length = 0;
      const auto [end, error] = std::from_chars(rest_.data(), rest_.data() + rest_.size(), length);
      if (error != std::errc() || lengths.size() == kMostDimensions) return false;
      rest_.remove_prefix(end - rest_.data());
      lengths.push_back(length);
      if (!accept(",")) return accept(")");
    }
    return true;
  }

  std::string_view rest_;
};

/// As Python writes strings.
std::string quoted_name(const std::string& name) {
  std::string text = "'";
  for (const char c : name) {
    if (c == '\'' || c == '\\') text += '\\';
    text += static_cast<unsigned char>(c) < ' ' ? ' ' : c;
  }
  return text + '\'';
}

/// What `descr` is.
std::string type_text(const NpyHeader& header) {
  if (header.fields.empty()) return fmt::format("'{}'", header.type);
  std::vector<std::string> fields;
  for (const NpyField& field : header.fields) {
    fields.push_back(
        fmt::format("({}, '{}'{})", quoted_name(field.name), field.type,
                    field.elements == 1 ? "" : fmt::format(", ({},)", field.elements)));
  }
  return fmt::format("[{}]", fmt::join(fields, ", "));
}

}  // namespace

NpyHeader read_npy_header(InputBytes& source) {
  source.check_not_empty();
  std::array<std::byte, 12> start;
  const std::span<std::byte> prefix = std::span(start).first(kNpyMagic.size() + 2);
  const std::size_t got = source.read(prefix);
  if (!as_text(prefix.first(got)).starts_with(kNpyMagic)) {
    fail(source, 0, "this is not an npy file: it does not begin with \\x93NUMPY; name its format");
  }
  const auto major = got < prefix.size() ? 0 : std::to_integer<int>(prefix[kNpyMagic.size()]);
  const auto minor = got < prefix.size() ? 0 : std::to_integer<int>(prefix[kNpyMagic.size() + 1]);
  const std::span<std::byte> length_bytes =
      std::span(start).subspan(prefix.size(), major == 1 ? 2 : 4);
  if (got == prefix.size() && (major < 1 || major > 3)) {
    fail(source, kNpyMagic.size(),
         fmt::format("the file says npy version {}.{}, but only 1.0 to 3.0 are read; save "
                     "the array again",
                     major, minor));
  }
  if (got < prefix.size() || source.read(length_bytes) < length_bytes.size()) {
    fail(source, source.position(),
         fmt::format("the file ends at byte {}, within its header; get a complete copy",
                     source.position()));
  }
  const std::size_t length = major == 1 ? load<std::uint16_t>(length_bytes.data())
                                        : load<std::uint32_t>(length_bytes.data());
  if (length > kLongestDictionary) {
    fail(source, prefix.size(),
         fmt::format("the header says it has {} bytes, but {} is the most that is read; the "
                     "file is corrupt",
                     length, kLongestDictionary));
  }
  std::vector<std::byte> dictionary(length);
  if (source.read(dictionary) < length) {
    fail(source, source.position(),
         fmt::format("the file ends at byte {}, within its header; get a complete copy",
                     source.position()));
  }
  std::optional<NpyHeader> header = DictionaryParser(as_text(dictionary)).parse();
  if (!header) {
    fail(source, source.position() - length,
         fmt::format("the header at byte {} does not describe one array (descr, "
                     "fortran_order, shape); save the points as an n x 2 or n x 3 array",
                     source.position() - length));
  }
  header->version = fmt::format("{}.{}", major, minor);
  return *header;
}

std::string npy_header_bytes(const NpyHeader& header, const std::string& name) {
  constexpr std::size_t kMostDigits = 20;  // of a number of 64 bits
  std::string dictionary =
      fmt::format("{{'descr': {}, 'fortran_order': {}, 'shape': ({}{}), }}", type_text(header),
                  header.fortran_order ? "True" : "False", fmt::join(header.shape, ", "),
                  header.shape.size() == 1 ? "," : "");
  const bool is_ascii =
      std::ranges::all_of(dictionary, [](char c) { return static_cast<unsigned char>(c) < 0x80; });
  const std::size_t before = kNpyMagic.size() + (is_ascii ? 4 : 6);
  const std::size_t digits = header.shape.empty() ? 0 : fmt::format("{}", header.shape[0]).size();
  const std::size_t longest = before + dictionary.size() + kMostDigits - digits + 1;
  const std::size_t total = (longest + kAlignment - 1) / kAlignment * kAlignment;
  dictionary.resize(total - before - 1, ' ');
  dictionary += '\n';
  if (dictionary.size() > kLongestDictionary - 1) {
    throw CannotWrite(
        name,
        fmt::format("the names of the attributes take {} bytes in an npy header, which "
                    "has {}; write spp",
                    dictionary.size(), kLongestDictionary - 1),
        ErrorCode::kTooLarge, {}, Remedy::kAttributes);
  }
  std::string bytes(kNpyMagic);
  bytes += {is_ascii ? '\x01' : '\x03', '\x00', static_cast<char>(dictionary.size() & 0xff),
            static_cast<char>(dictionary.size() >> 8)};
  if (!is_ascii) bytes += {'\x00', '\x00'};
  return bytes + dictionary;
}

}  // namespace spillway::formats
