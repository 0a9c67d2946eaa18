#include "formats/points/pcd/pcd_header.h"

#include <fmt/format.h>

#include <array>
#include <optional>
#include <utility>

#include "formats/bytes/bytes.h"
#include "formats/bytes/fields.h"
#include "formats/bytes/line_reader.h"
#include "src/error.h"

namespace spillway::formats {
namespace {

constexpr std::size_t kLongestHeader = std::size_t{1} << 16;
constexpr std::size_t kMostFields = 256;
constexpr std::size_t kLongestPoint = std::size_t{1} << 20;  // bytes

/// The type of a letter of TYPE and a number of SIZE.
std::optional<NumberType> number_type(std::string_view letter, std::uint64_t size) {
  constexpr std::array<std::pair<std::string_view, NumberType>, 10> kTypes = {
      {{"I1", NumberType::kInt8},
       {"I2", NumberType::kInt16},
       {"I4", NumberType::kInt32},
       {"I8", NumberType::kInt64},
       {"U1", NumberType::kUint8},
       {"U2", NumberType::kUint16},
       {"U4", NumberType::kUint32},
       {"U8", NumberType::kUint64},
       {"F4", NumberType::kFloat32},
       {"F8", NumberType::kFloat64}}};
  const std::string wanted = fmt::format("{}{}", letter, size);
  for (const auto& [name, type] : kTypes) {
    if (name == wanted) return type;
  }
  return std::nullopt;
}

std::vector<std::string> words_of(Fields fields) {
  std::vector<std::string> words;
  while (!fields.at_end()) words.emplace_back(fields.word());
  return words;
}

/// Reads the entries, which come one a line.
class HeaderLines {
 public:
  explicit HeaderLines(InputBytes& source) : source_(source) {}

  PcdHeader read() {
    std::size_t bytes = 0;
    while (header_.lines == 0 || !is_last_) {
      const std::string_view text = as_text(source_.peek(kLongestHeader)).substr(bytes);
      const std::size_t end = text.find('\n');
      ++header_.lines;
      if (end == text.npos) {
        fail(bytes + text.size() < kLongestHeader
                 ? "the file ends within its header, before the line DATA; get a complete copy"
                 : "there is no line DATA in the first 64 KiB; the file is corrupt");
      }
      take(text.substr(0, end));
      bytes += end + 1;
    }
    source_.skip(bytes);
    complete();
    return std::move(header_);
  }

 private:
  [[noreturn]] void fail(const std::string& what) const {
    throw BadInput(source_.name(), fmt::format("line {} of the header: {}", header_.lines, what),
                   at_line(header_.lines));
  }

  void take(std::string_view line) {
    if (line.ends_with('\r')) line.remove_suffix(1);
    Fields fields(line);
    const std::string_view key = fields.word();
    if (key.empty() || key.starts_with('#')) return;
    if (key == "VERSION") {
      header_.version = fields.word();
    } else if (key == "FIELDS" || key == "COLUMNS") {
      names_ = words_of(fields);
    } else if (key == "SIZE") {
      sizes_ = counts_of(fields);
    } else if (key == "TYPE") {
      types_ = words_of(fields);
    } else if (key == "COUNT") {
      counts_ = counts_of(fields);
    } else if (key == "WIDTH") {
      width_ = count_in(fields);
    } else if (key == "HEIGHT") {
      height_ = count_in(fields);
    } else if (key == "VIEWPOINT") {
      take_viewpoint(fields);
    } else if (key == "POINTS") {
      points_ = count_in(fields);
    } else if (key == "DATA") {
      take_encoding(fields.word());
    } else {
      fail(fmt::format("{} is no entry of PCD; the file is corrupt", quoted(key)));
    }
  }

  [[nodiscard]] std::uint64_t count_in(Fields& fields) const {
    const std::optional<std::uint64_t> count = fields.count();
    if (!count) fail("a whole number is expected, not negative");
    return *count;
  }

  [[nodiscard]] std::vector<std::uint64_t> counts_of(Fields fields) const {
    std::vector<std::uint64_t> counts;
    while (!fields.at_end()) counts.push_back(count_in(fields));
    return counts;
  }

  void take_viewpoint(Fields fields) {
    constexpr std::array<double, 7> kNone = {0, 0, 0, 1, 0, 0, 0};
    for (const double none : kNone) {
      if (fields.number().value_or(none) != none) header_.has_viewpoint = true;
    }
  }

  void take_encoding(std::string_view word) {
    is_last_ = true;
    if (word == "ascii") {
      header_.encoding = PcdEncoding::kAscii;
    } else if (word == "binary") {
      header_.encoding = PcdEncoding::kBinary;
    } else if (word == "binary_compressed") {
      header_.encoding = PcdEncoding::kCompressed;
    } else {
      fail(fmt::format("DATA is {}, none of ascii, binary and binary_compressed", quoted(word)));
    }
  }

  /// Puts together what the entries say.
  void complete() {
    if (names_.empty()) fail("no FIELDS are named");
    if (names_.size() > kMostFields) {
      fail(fmt::format("there are {} FIELDS; at most {} are read", names_.size(), kMostFields));
    }
    if (counts_.empty()) counts_.assign(names_.size(), 1);
    for (const auto& [entry, count] :
         {std::pair("SIZE", sizes_.size()), std::pair("TYPE", types_.size()),
          std::pair("COUNT", counts_.size())}) {
      if (count == names_.size()) continue;
      fail(fmt::format("{} has {} values for {} FIELDS", entry, count, names_.size()));
    }
    std::uint64_t bytes = 0;
    for (std::size_t i = 0; i < names_.size(); ++i) {
      const std::optional<NumberType> type = number_type(types_[i], sizes_[i]);
      if (!type) {
        fail(
            fmt::format("the field {} is of TYPE {} and SIZE {}; known are I and U of 1, 2, 4 and "
                        "8 bytes, and F of 4 and 8",
                        names_[i], types_[i], sizes_[i]));
      }
      if (counts_[i] == 0 || counts_[i] > kLongestPoint ||
          (bytes += counts_[i] * size_of(*type)) > kLongestPoint) {
        fail(
            fmt::format("the field {} has a COUNT of {}: a point has 1 number or more of each "
                        "field, and at most {} bytes",
                        names_[i], counts_[i], kLongestPoint));
      }
      header_.fields.push_back({names_[i], *type, static_cast<std::size_t>(counts_[i])});
    }
    count_points();
  }

  void count_points() {
    constexpr std::uint64_t kMost = std::uint64_t{1} << 48;
    std::optional<std::uint64_t> grid;
    if (width_) {
      const std::uint64_t height = height_.value_or(1);
      if (*width_ > kMost || (height > 0 && *width_ > kMost / height)) fail("WIDTH is too large");
      grid = *width_ * height;
    }
    if (!points_ && !grid) fail("neither POINTS nor WIDTH says how many points there are");
    if (points_ && grid && *points_ != *grid) {
      fail(fmt::format("there are {} POINTS, but WIDTH times HEIGHT is {}", *points_, *grid));
    }
    header_.points = points_ ? *points_ : *grid;
  }

  InputBytes& source_;
  PcdHeader header_;
  bool is_last_ = false;
  std::vector<std::string> names_;
  std::vector<std::uint64_t> sizes_;
  std::vector<std::string> types_;
  std::vector<std::uint64_t> counts_;
  std::optional<std::uint64_t> width_;
  std::optional<std::uint64_t> height_;
  std::optional<std::uint64_t> points_;
};

}  // namespace

bool begins_as_pcd(std::string_view first_bytes) {
  if (first_bytes.starts_with("# .PCD v")) return true;
  while (first_bytes.starts_with('#')) {
    const std::size_t end = first_bytes.find('\n');
    if (end == first_bytes.npos) return false;
    first_bytes.remove_prefix(end + 1);
  }
  return begins_with_word(first_bytes, "VERSION") &&
         first_bytes.find("\nFIELDS ") != first_bytes.npos;
}

PcdHeader read_pcd_header(InputBytes& source) { return HeaderLines(source).read(); }

}  // namespace spillway::formats
