#include "formats/points/text/text_columns.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <cstring>
#include <system_error>
#include <utility>

#include "formats/bytes/line_reader.h"

namespace spillway::formats {
namespace {

constexpr std::size_t kLongestNumber = 128;

bool is_digit(char c) { return c >= '0' && c <= '9'; }

/// How many commas there are, eight bytes at a time: attributes after the columns that are read
/// are long, and this is all that is done with them.
std::size_t count_commas(std::string_view text) {
  constexpr std::uint64_t kOnes = 0x0101010101010101;
  constexpr std::uint64_t kLow = 0x7f * kOnes;
  std::size_t count = 0;
  for (; text.size() >= sizeof(std::uint64_t); text.remove_prefix(sizeof(std::uint64_t))) {
    std::uint64_t bytes = 0;
    std::memcpy(&bytes, text.data(), sizeof(bytes));
    bytes ^= ',' * kOnes;
    const std::uint64_t zeros = ~(((bytes & kLow) + kLow) | bytes | kLow);  // 0x80 for each comma
    count += ((zeros >> 7) * kOnes) >> 56;
  }
  for (const char c : text) count += c == ',' ? 1 : 0;
  return count;
}

/// How many fields there are where blanks separate.
std::size_t count_fields(std::string_view text) {
  if (text.find('"') != text.npos) return text_fields(text, Separator::kBlanks).size();
  std::size_t count = 0;
  while (!is_comment(text)) {
    text.remove_prefix(text.find_first_not_of(" \t"));
    text.remove_prefix(std::min(text.find_first_of(" \t"), text.size()));
    ++count;
  }
  return count;
}

// Powers of ten by which a whole number below 2^53 can be divided with one rounding.
constexpr std::array kPowersOfTen = {1e0, 1e1, 1e2,  1e3,  1e4,  1e5,  1e6,  1e7,
                                     1e8, 1e9, 1e10, 1e11, 1e12, 1e13, 1e14, 1e15};

/// Reads what most numbers are: at most 15 digits, with or without decimals. The nearest double is
/// then one division (W. Clinger, "How to Read Floating Point Numbers Accurately", 1990). Null for
/// anything else.
const char* read_short_number(const char* at, const char* end, double& value) {
  const bool negative = at != end && *at == '-';
  if (negative) ++at;
  std::uint64_t digits = 0;
  std::size_t count = 0;
  std::size_t decimals = 0;
  const auto read_digits = [&] {
    const char* const begin = at;
    for (; at != end && is_digit(*at); ++at)
      digits = 10 * digits + static_cast<unsigned>(*at - '0');
    count += at - begin;
    return static_cast<std::size_t>(at - begin);
  };
  read_digits();
  if (at != end && *at == '.') {
    ++at;
    decimals = read_digits();
  }
  if (count == 0 || count >= kPowersOfTen.size()) return nullptr;
  if (at != end && (*at == 'e' || *at == 'E')) return nullptr;
  const double size = static_cast<double>(digits) / kPowersOfTen[decimals];
  value = negative ? -size : size;
  return at;
}

/// Reads a number with a decimal point from the front of the text; null if there is none. A leading
/// plus sign is allowed.
const char* read_number(const char* at, const char* end, double& value) {
  if (at != end && *at == '+' && at + 1 != end && at[1] != '-') ++at;
  if (const char* const after = read_short_number(at, end, value)) return after;
  const auto [after, error] = std::from_chars(at, end, value);
  return error == std::errc() ? after : nullptr;
}

/// The quote that ends a field, of which two side by side are one of its characters; `end` if there
/// is none.
const char* closing_quote(const char* at, const char* end) {
  while (true) {
    at = std::find(at, end, '"');
    if (at == end || at + 1 == end || at[1] != '"') return at;
    at += 2;
  }
}

/// Walks along the fields of a line; a field may be in double quotes.
template <Separator S>
class Fields {
 public:
  explicit Fields(std::string_view line) : at_(line.data()), end_(line.data() + line.size()) {
    skip_blanks();
  }

  [[nodiscard]] bool at_end() const { return at_ == end_; }
  [[nodiscard]] std::string_view rest() const {
    return {at_, static_cast<std::size_t>(end_ - at_)};
  }

  /// Reads a number; false if the field is none, and then the place in the line is undefined.
  bool number(double& value) {
    const bool in_quotes = at_ != end_ && *at_ == '"';
    if (in_quotes) ++at_;
    const char* const after = read_number(at_, end_, value);
    if (after == nullptr) return false;
    at_ = after;
    if (in_quotes && (at_ == end_ || *at_++ != '"')) return false;
    return end_field();
  }

  /// Reads a field of any kind, without its quotes; empty where there is none. False if more
  /// follows its quotes than may stand there.
  bool text(std::string_view& field) {
    if (at_ != end_ && *at_ == '"') {
      const char* const start = ++at_;
      at_ = closing_quote(at_, end_);
      field = {start, static_cast<std::size_t>(at_ - start)};
      if (at_ != end_) ++at_;
      return end_field();
    }
    const char* const start = at_;
    at_ = std::find_if(at_, end_, [](char c) {
      return S == Separator::kBlanks ? is_blank(c) : c == static_cast<char>(S);
    });
    field = {start, static_cast<std::size_t>(at_ - start)};
    while (!field.empty() && is_blank(field.back())) field.remove_suffix(1);
    return end_field();
  }

 private:
  static bool is_blank(char c) { return c == ' ' || (c == '\t' && S != Separator::kTab); }

  void skip_blanks() {
    while (at_ != end_ && is_blank(*at_)) ++at_;
  }

  /// Moves on to the next field; false if the field does not end here.
  bool end_field() {
    if (at_ == end_) return true;
    const bool blank = is_blank(*at_);
    if (blank) skip_blanks();
    if (S == Separator::kBlanks) return blank;
    if (at_ == end_) return true;
    if (*at_ != static_cast<char>(S)) return blank && is_comment(rest());
    ++at_;
    skip_blanks();
    return true;
  }

  const char* at_;
  const char* end_;
};

template <Separator S>
void put_fields(std::string_view line, bool comments, std::vector<std::string_view>& fields) {
  Fields<S> walk(line);
  while (!walk.at_end() && !(comments && is_comment(walk.rest()))) {
    std::string_view field;
    const std::string_view rest = walk.rest();
    // What follows a quoted text without a separator belongs to the field.
    if (!walk.text(field)) {
      const std::size_t end = S == Separator::kBlanks
                                  ? rest.find_first_of(" \t", field.size() + 2)
                                  : rest.find(static_cast<char>(S), field.size() + 2);
      field = rest.substr(0, end);
      walk = Fields<S>(end == rest.npos ? std::string_view() : rest.substr(end + 1));
    }
    fields.push_back(field);
  }
}

void put_fields(std::string_view line, Separator separator, bool comments,
                std::vector<std::string_view>& fields) {
  fields.clear();
  switch (separator) {
    case Separator::kTab:
      return put_fields<Separator::kTab>(line, comments, fields);
    case Separator::kComma:
      return put_fields<Separator::kComma>(line, comments, fields);
    case Separator::kSemicolon:
      return put_fields<Separator::kSemicolon>(line, comments, fields);
    case Separator::kNone:
      fields.push_back(line);
      return;
    case Separator::kBlanks:
      break;
  }
  put_fields<Separator::kBlanks>(line, comments, fields);
}

/// The bytes of a character of UTF-8 that begins so; 0 if none does.
std::size_t length_of_character(unsigned char first) {
  if (first < 0x80) return 1;
  if (first < 0xc2 || first > 0xf4) return 0;
  return first < 0xe0 ? 2 : first < 0xf0 ? 3 : 4;
}

/// The byte where that character of a line begins, or the line's end. In a line that is no UTF-8,
/// bytes are characters.
std::size_t byte_of_character(std::string_view line, std::size_t number) {
  std::size_t at = 0;
  for (std::size_t c = 0; c < number && at < line.size(); ++c) {
    const std::size_t length = length_of_character(static_cast<unsigned char>(line[at]));
    const std::string_view rest = line.substr(at + 1, length == 0 ? 0 : length - 1);
    const bool is_whole = rest.size() + 1 == length && std::ranges::all_of(rest, [](char byte) {
                            return (static_cast<unsigned char>(byte) & 0xc0U) == 0x80;
                          });
    if (!is_whole) return std::min(number, line.size());
    at += length;
  }
  return at;
}

/// The characters of a line that are there, without blanks around them.
std::string_view characters_of(std::string_view line, const std::array<std::size_t, 2>& range) {
  const std::size_t begin = byte_of_character(line, range[0]);
  line = line.substr(begin, byte_of_character(line, range[1]) - begin);
  line.remove_prefix(std::min(line.find_first_not_of(" \t"), line.size()));
  return line.substr(0, line.find_last_not_of(" \t") + 1);
}

}  // namespace

std::string_view name_of(Separator separator) {
  switch (separator) {
    case Separator::kTab:
      return "tabs";
    case Separator::kComma:
      return "commas";
    case Separator::kSemicolon:
      return "semicolons";
    case Separator::kNone:
      return "nothing";
    case Separator::kBlanks:
      break;
  }
  return "blanks";
}

std::string_view option_name_of(Separator separator) {
  switch (separator) {
    case Separator::kTab:
      return "tab";
    case Separator::kComma:
      return "comma";
    case Separator::kSemicolon:
      return "semicolon";
    case Separator::kNone:
      return "none";
    case Separator::kBlanks:
      break;
  }
  return "blanks";
}

std::string without_doubled_quotes(std::string_view field) {
  std::string text;
  for (std::size_t i = 0; i < field.size(); ++i) {
    text += field[i];
    if (field[i] == '"' && i + 1 < field.size() && field[i + 1] == '"') ++i;
  }
  return text;
}

std::vector<std::string_view> text_fields(std::string_view line, Separator separator) {
  std::vector<std::string_view> fields;
  put_text_fields(line, separator, fields);
  return fields;
}

void put_text_fields(std::string_view line, Separator separator,
                     std::vector<std::string_view>& fields) {
  put_fields(line, separator, true, fields);
}

std::vector<std::string_view> text_names(std::string_view line, Separator separator) {
  std::vector<std::string_view> fields;
  put_fields(line, separator, separator == Separator::kBlanks, fields);
  return fields;
}

bool is_comment(std::string_view line) {
  line.remove_prefix(std::min(line.find_first_not_of(" \t"), line.size()));
  return line.empty() || line[0] == '#' || line[0] == '%' || line.starts_with("//");
}

bool read_decimal(std::string_view field, bool decimal_commas, double& value) {
  std::array<char, kLongestNumber> copy;
  const std::size_t comma = field.find(',');
  if (decimal_commas && comma != field.npos) {
    const bool between_digits = comma > 0 && is_digit(field[comma - 1]) &&
                                comma + 1 < field.size() && is_digit(field[comma + 1]);
    if (!between_digits || field.size() > copy.size()) return false;
    if (field.find('.') != field.npos) return false;
    std::copy(field.begin(), field.end(), copy.begin());
    copy[comma] = '.';
    field = {copy.data(), field.size()};
  } else if (decimal_commas && field.find('.') != field.npos) {
    return false;
  }
  const char* const end = field.data() + field.size();
  return !field.empty() && read_number(field.data(), end, value) == end;
}

TextColumns::TextColumns(Separator separator, bool decimal_commas, const std::array<int, 3>& column,
                         std::size_t count, bool named)
    : separator_(separator),
      decimal_commas_(decimal_commas),
      coordinates_(column[2] < 0 ? 2 : 3),
      count_(count),
      exact_count_(named && separator == Separator::kBlanks),
      axes_(*std::max_element(column.begin(), column.end()) + 1, -1) {
  for (int axis = 0; axis < coordinates_; ++axis) axes_[column[axis]] = axis;
}

TextColumns::TextColumns(bool decimal_commas, std::vector<std::array<std::size_t, 2>> characters)
    : separator_(Separator::kNone),
      decimal_commas_(decimal_commas),
      coordinates_(static_cast<int>(characters.size())),
      count_(characters.size()),
      exact_count_(false),
      characters_(std::move(characters)) {}

bool TextColumns::parse_characters(std::string_view line, LatticePoint& point) const {
  point[2] = 0;
  if (is_comment(line)) return false;
  for (std::size_t axis = 0; axis < characters_.size(); ++axis) {
    if (!read_decimal(characters_of(line, characters_[axis]), decimal_commas_, point[axis])) {
      return false;
    }
  }
  return true;
}

bool TextColumns::parse(std::string_view line, LatticePoint& point) const {
  switch (separator_) {
    case Separator::kTab:
      return parse_as<Separator::kTab>(line, point);
    case Separator::kComma:
      return parse_as<Separator::kComma>(line, point);
    case Separator::kSemicolon:
      return parse_as<Separator::kSemicolon>(line, point);
    case Separator::kNone:
      return parse_characters(line, point);
    case Separator::kBlanks:
      break;
  }
  return parse_as<Separator::kBlanks>(line, point);
}

template <Separator S>
bool TextColumns::parse_as(std::string_view line, LatticePoint& point) const {
  point[2] = 0;
  Fields<S> fields(line);
  for (const int axis : axes_) {
    std::string_view field;
    if (axis >= 0 && !decimal_commas_) {
      if (!fields.number(point[axis])) return false;
    } else {
      if (fields.at_end() || is_comment(fields.rest()) || !fields.text(field)) return false;
      if (axis >= 0 && !read_decimal(field, true, point[axis])) return false;
    }
  }
  if (turned_) point[2] = 0 - point[2];
  if (fields.at_end()) return !exact_count_ || axes_.size() == count_;
  return rest_fits(fields.rest());
}

bool TextColumns::rest_fits(std::string_view rest) const {
  if (separator_ == Separator::kComma) {
    if (axes_.size() + count_commas(rest) < count_) return true;
    std::vector<std::string_view> fields = text_fields(rest, separator_);
    while (!fields.empty() && fields.back().empty()) fields.pop_back();
    return axes_.size() + fields.size() <= count_;
  }
  if (exact_count_ && axes_.size() + count_fields(rest) != count_) return false;
  if (separator_ != Separator::kBlanks || decimal_commas_ || rest.find(',') == rest.npos) {
    return true;
  }
  const std::vector<std::string_view> fields = text_fields(rest, separator_);
  double value = 0;
  return std::none_of(fields.begin(), fields.end(), [&](std::string_view field) {
    return field.find(',') != field.npos && read_decimal(field, true, value);
  });
}

std::string TextColumns::fault_of_characters(std::string_view line) const {
  for (const auto& range : characters_) {
    const std::string_view field = characters_of(line, range);
    double value = 0;
    if (read_decimal(field, decimal_commas_, value)) continue;
    return fmt::format(
        "characters {} to {} are not a number with decimal {}: {} in {}; correct or "
        "remove the line",
        range[0] + 1, range[1], decimal_commas_ ? "commas" : "points", quoted(field), quoted(line));
  }
  return "";
}

std::string TextColumns::fault(std::string_view line) const {
  if (separator_ == Separator::kNone) return fault_of_characters(line);
  const std::vector<std::string_view> fields = text_fields(line, separator_);
  double value = 0;
  for (std::size_t i = 0; i < axes_.size(); ++i) {
    if (i >= fields.size()) {
      return fmt::format("column {} is missing: {}; each line needs {} columns separated by {}",
                         i + 1, quoted(line), axes_.size(), name_of(separator_));
    }
    if (axes_[i] < 0 || read_decimal(fields[i], decimal_commas_, value)) continue;
    return fmt::format("column {}{}", i + 1, fault_of_field(fields[i]));
  }
  for (std::size_t i = axes_.size(); i < fields.size(); ++i) {
    if (separator_ == Separator::kBlanks && fields[i].find(',') != fields[i].npos &&
        read_decimal(fields[i], true, value)) {
      return fmt::format("column {}{}", i + 1, fault_of_field(fields[i]));
    }
  }
  if (separator_ == Separator::kComma && fields.size() > count_) {
    return fmt::format(
        "column {} is one more than the {} of the header or the first row: {}; write decimal "
        "points instead of decimal commas, or separate columns by semicolons",
        count_ + 1, count_, quoted(line));
  }
  if (exact_count_ && fields.size() != count_) {
    return fmt::format(
        "column {} {}, where the header names {}: {}; write names and fields without blanks, or "
        "separate columns by tabs or semicolons",
        std::min(fields.size(), count_) + 1, fields.size() < count_ ? "is missing" : "is one more",
        count_, quoted(line));
  }
  return fmt::format(
      "it does not fit columns separated by {}: {}; correct or "
      "remove it",
      name_of(separator_), quoted(line));
}

std::string TextColumns::fault_of_field(std::string_view field) const {
  double value = 0;
  if (field.empty()) return " is empty; fill it in or remove the line";
  if (read_decimal(field, !decimal_commas_, value)) {
    const char* const has = decimal_commas_ ? "point" : "comma";
    const char* const others = decimal_commas_ ? "commas" : "points";
    return fmt::format(
        " has a decimal {}, {}, where the file is read with decimal {}; write one "
        "kind in the whole file",
        has, quoted(field), others);
  }
  return fmt::format(
      " is not a number: {}, where columns are separated by {} and decimals by {}; "
      "correct or remove it",
      quoted(field), name_of(separator_), decimal_commas_ ? "commas" : "points");
}

}  // namespace spillway::formats
