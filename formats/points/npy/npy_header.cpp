#include "formats/points/npy/npy_header.h"

#include <fmt/format.h>

#include <array>
#include <charconv>

#include "formats/bytes/bytes.h"
#include "src/error.h"

namespace spillway::detail {
namespace {

constexpr std::size_t kLongestDictionary = 65536;
constexpr std::size_t kAlignment = 64;
constexpr std::size_t kMostDimensions = 32;

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
        const std::optional<std::string> type = string();
        valid = has_type = type.has_value();
        if (type) header.type = *type;
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

  std::optional<std::string> string() {
    skip_blanks();
    if (rest_.empty() || (rest_[0] != '\'' && rest_[0] != '"')) return std::nullopt;
    const std::size_t end = rest_.find(rest_[0], 1);
    if (end == std::string_view::npos) return std::nullopt;
    std::string result(rest_.substr(1, end - 1));
    rest_.remove_prefix(end + 1);
    return result;
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
         fmt::format("the header at byte {} does not describe one plain array (descr, "
                     "fortran_order, shape); save the points as an n x 2 or n x 3 array",
                     source.position() - length));
  }
  header->version = fmt::format("{}.{}", major, minor);
  return *header;
}

std::string npy_header_bytes(const NpyHeader& header) {
  std::string dictionary =
      fmt::format("{{'descr': '{}', 'fortran_order': {}, 'shape': ({}{}), }}", header.type,
                  header.fortran_order ? "True" : "False", fmt::join(header.shape, ", "),
                  header.shape.size() == 1 ? "," : "");
  const std::size_t before = kNpyMagic.size() + 4;
  const std::size_t total = before + dictionary.size() + 1;
  dictionary.append((kAlignment - total % kAlignment) % kAlignment, ' ');
  dictionary += '\n';
  std::string bytes(kNpyMagic);
  bytes += {'\x01', '\x00', static_cast<char>(dictionary.size() & 0xff),
            static_cast<char>(dictionary.size() >> 8)};
  return bytes + dictionary;
}

}  // namespace spillway::detail
