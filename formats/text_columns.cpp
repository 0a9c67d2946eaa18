#include "formats/text_columns.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <initializer_list>
#include <string>
#include <system_error>
#include <utility>

namespace spillway {
namespace {

bool is_blank(char c) { return c == ' ' || c == '\t'; }
bool is_separator(char c) { return c == ',' || c == ';'; }

/// Walks along the fields of a line. Blanks separate fields, and so does one comma or semicolon
/// with any blanks around it; a field may be in double quotes.
class Fields {
 public:
  explicit Fields(std::string_view line) : at_(line.data()), end_(line.data() + line.size()) {
    skip_blanks();
  }

  /// Whether there is no further field: the end of the line or a comment.
  [[nodiscard]] bool done() const {
    return at_ == end_ || is_comment(std::string_view(at_, end_ - at_));
  }

  /// What separated the last field from what follows: ',', ';', or ' ' for blanks or the end.
  [[nodiscard]] char separator() const { return separator_; }

  /// Reads a number; false if the field is none, and then the place in the line is undefined.
  bool number(double& value) {
    const bool in_quotes = at_ != end_ && *at_ == '"';
    if (in_quotes) ++at_;
    if (at_ != end_ && *at_ == '+' && at_ + 1 != end_ && at_[1] != '-') ++at_;
    const auto [after, error] = std::from_chars(at_, end_, value);
    if (error != std::errc()) return false;
    at_ = after;
    if (in_quotes && (at_ == end_ || *at_++ != '"')) return false;
    return end_field();
  }

  /// Reads a field of any kind, without its quotes; empty where there is none.
  std::string_view text() {
    const bool in_quotes = at_ != end_ && *at_ == '"';
    if (in_quotes) ++at_;
    const char* const start = at_;
    at_ = std::find_if(
        at_, end_, [&](char c) { return in_quotes ? c == '"' : is_blank(c) || is_separator(c); });
    const std::string_view field(start, at_ - start);
    if (in_quotes)
      at_ = std::find_if(at_, end_, [](char c) { return is_blank(c) || is_separator(c); });
    end_field();
    return field;
  }

 private:
  void skip_blanks() {
    while (at_ != end_ && is_blank(*at_)) ++at_;
  }

  /// Moves on to the next field; false if the field does not end here.
  bool end_field() {
    if (at_ != end_ && !is_blank(*at_) && !is_separator(*at_)) return false;
    skip_blanks();
    separator_ = at_ != end_ && is_separator(*at_) ? *at_ : ' ';
    if (separator_ != ' ') {
      ++at_;
      skip_blanks();
    }
    return true;
  }

  const char* at_;
  const char* end_;
  char separator_ = ' ';
};

/// The axis that a column of this name holds, or -1.
int axis_of_name(std::string_view name) {
  using Names = std::initializer_list<std::string_view>;
  static const std::array<Names, 3> names = {
      Names{"x", "lon", "long", "longitude", "east", "easting"},
      Names{"y", "lat", "latitude", "north", "northing"},
      Names{"z", "alt", "altitude", "elev", "elevation", "height"}};
  std::string lower(name);
  std::transform(lower.begin(), lower.end(), lower.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  for (int axis = 0; axis < 3; ++axis) {
    if (std::find(names[axis].begin(), names[axis].end(), lower) != names[axis].end()) {
      return axis;
    }
  }
  return -1;
}

}  // namespace

TextColumns TextColumns::first(int coordinates) {
  TextColumns columns;
  columns.coordinates_ = coordinates;
  for (int axis = 0; axis < coordinates; ++axis) columns.axes_.push_back(axis);
  return columns;
}

std::optional<TextColumns> TextColumns::named(std::string_view header_line) {
  TextColumns columns;
  std::array<bool, 3> found{};
  for (Fields fields(header_line); !fields.done();) {
    int axis = axis_of_name(fields.text());
    if (axis >= 0 && std::exchange(found[axis], true)) axis = -1;
    columns.axes_.push_back(axis);
  }
  if (!found[0] || !found[1]) return std::nullopt;
  columns.coordinates_ = found[2] ? 3 : 2;
  while (columns.axes_.back() < 0) columns.axes_.pop_back();
  return columns;
}

bool TextColumns::parse(std::string_view line, Point<3>& point) const {
  point[2] = 0;
  Fields fields(line);
  for (const int axis : axes_) {
    if (axis < 0) {
      if (fields.done()) return false;
      fields.text();
    } else if (!fields.number(point[axis])) {
      return false;
    }
  }
  return true;
}

bool TextColumns::mixes_separators(std::string_view line) const {
  Fields fields(line);
  char common = 0;
  for (std::size_t i = 0; i + 1 < axes_.size(); ++i) {
    fields.text();
    if (common != 0 && fields.separator() != common) return true;
    common = fields.separator();
  }
  return false;
}

int column_count(std::string_view line) {
  int count = 0;
  for (Fields fields(line); !fields.done(); ++count) fields.text();
  return count;
}

bool is_comment(std::string_view line) {
  line.remove_prefix(std::min(line.find_first_not_of(" \t"), line.size()));
  return line.empty() || line[0] == '#' || line[0] == '%' || line.starts_with("//");
}

bool is_header(std::string_view line) {
  Fields fields(line);
  for (int i = 0; i < 3 && !fields.done(); ++i) {
    double value = 0;
    if (Fields ahead = fields; ahead.number(value)) return false;
    fields.text();
  }
  return true;
}

}  // namespace spillway
