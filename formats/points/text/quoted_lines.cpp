#include "formats/points/text/quoted_lines.h"

#include <fmt/format.h>

namespace spillway::formats {

bool QuoteScan::goes_on(std::string_view line) {
  if (separator_ == Separator::kNone || separator_ == Separator::kBlanks) return false;
  if (at_ == 0 && line.find('"') == line.npos) return false;
  const char separator = static_cast<char>(separator_);
  const auto is_blank = [&](char c) { return c == ' ' || (c == '\t' && separator != '\t'); };
  if (place_ == Place::kQuoted) is_of_lines_ = true;
  for (; at_ < line.size(); ++at_) {
    const char c = line[at_];
    switch (place_) {
      case Place::kFieldBegin:
        if (is_blank(c) || c == separator) continue;
        is_of_lines_ = false;
        place_ = c == '"'                       ? Place::kQuoted
                 : is_comment(line.substr(at_)) ? Place::kComment
                                                : Place::kPlain;
        break;
      case Place::kPlain:
        if (c == separator) place_ = Place::kFieldBegin;
        break;
      case Place::kQuoted:
        if (c != '"') break;
        if (at_ + 1 < line.size() && line[at_ + 1] == '"') {
          ++at_;
        } else {
          place_ = Place::kBehindQuotes;
        }
        break;
      case Place::kBehindQuotes:
        if (c == separator) {
          place_ = Place::kFieldBegin;
        } else if (!is_blank(c)) {
          is_broken_ = is_broken_ || is_of_lines_;
          place_ = Place::kPlain;
        }
        break;
      case Place::kComment:
        return false;
    }
  }
  return place_ == Place::kQuoted;
}

std::string complete_in_quotes(LineReader& lines, std::string_view& line, Separator separator) {
  QuoteScan scan(separator);
  while (scan.goes_on(line)) {
    if (line.size() > QuoteScan::kLongest) {
      return "has a field in quotes that goes on for more than 64 KiB; close it, or remove its "
             "quote";
    }
    if (!lines.extend(line)) {
      return "has a field in quotes that does not end; close it, or get a complete copy";
    }
  }
  if (!scan.is_broken()) return "";
  return fmt::format(
      "has a field in quotes that goes on in the next lines, where more follows its "
      "last quote: {}; close it in its line, write two quotes for one, or separate",
      quoted(line));
}

}  // namespace spillway::formats
