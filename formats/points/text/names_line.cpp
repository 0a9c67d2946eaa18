#include "formats/points/text/names_line.h"

#include <algorithm>
#include <utility>

namespace spillway::formats {
namespace {

char sign_of(Separator separator) { return static_cast<char>(separator); }

/// Whether a sign other than blanks separates fields of the line: stands outside of quotes.
bool occurs(Separator separator, std::string_view line) {
  bool in_quotes = false;
  return separator != Separator::kBlanks && std::any_of(line.begin(), line.end(), [&](char c) {
           in_quotes ^= c == '"';
           return !in_quotes && c == sign_of(separator);
         });
}

/// Without words in brackets, as the units in "x [m] y [m]".
std::string without_brackets(std::string_view text) {
  std::string result;
  while (!text.empty()) {
    const std::size_t blank = std::min(text.find_first_of(" \t"), text.size());
    const std::string_view word = text.substr(0, blank);
    const bool bracketed = (word.starts_with('(') && word.ends_with(')')) ||
                           (word.starts_with('[') && word.ends_with(']'));
    if (!bracketed) result += word;
    result += text.substr(blank, 1);
    text.remove_prefix(std::min(blank + 1, text.size()));
  }
  return std::string(trimmed(result));
}

/// Whether one of the names is a word that sentences have.
bool is_prose(const std::vector<std::string_view>& names) {
  constexpr std::array<std::string_view, 16> kWords = {"the", "of",   "and", "in", "is", "are",
                                                       "for", "by",   "to",  "as", "at", "with",
                                                       "or",  "from", "und", "von"};
  return std::any_of(names.begin(), names.end(), [&](std::string_view name) {
    return std::find(kWords.begin(), kWords.end(), name) != kWords.end();
  });
}

}  // namespace

std::string_view trimmed(std::string_view text) {
  constexpr std::string_view kBlanks = " \t\r";
  const std::size_t begin = text.find_first_not_of(kBlanks);
  if (begin == text.npos) return {};
  return text.substr(begin, text.find_last_not_of(kBlanks) - begin + 1);
}

Separator likely_separator(std::string_view line) {
  const auto* const found =
      std::find_if(kSeparators.begin(), kSeparators.end(),
                   [&](Separator separator) { return occurs(separator, trimmed(line)); });
  return found == kSeparators.end() ? Separator::kBlanks : *found;
}

std::string_view text_of_comment(std::string_view line) {
  line = trimmed(line);
  while (is_comment(line) && !line.empty()) {
    line = trimmed(line.substr(line.starts_with("//") ? 2 : 1));
  }
  return line;
}

NamesLine read_names(std::string_view line, Separator separator) {
  NamesLine result{separator, text_names(line, separator), {}};
  result.choice = choose_columns(result.names);
  return result;
}

NamesLine read_names(std::string_view line) {
  NamesLine likely = read_names(line, likely_separator(line));
  if (likely.choice.fault.empty()) return likely;
  for (const Separator separator : kSeparators) {
    const bool blanks = separator == Separator::kBlanks && occurs(Separator::kTab, trimmed(line));
    if (!blanks && !occurs(separator, trimmed(line))) continue;
    NamesLine other = read_names(line, separator);
    if (other.choice.fault.empty()) return other;
  }
  return likely;
}

std::optional<CommentHeader> CommentHeader::read(std::string_view comment, std::uint64_t line) {
  if (const std::size_t colon = comment.find(':'); colon != comment.npos) {
    CommentHeader header(comment.substr(colon + 1), line);
    if (header.names_plane()) return header;
  }
  CommentHeader header(comment, line);  // of all its text
  return header.names_plane() ? std::optional(std::move(header)) : std::nullopt;
}

bool CommentHeader::is_list(const NamesLine& names) {
  const std::size_t count = names.names.size();
  return names.choice.plain ? 2 * names.choice.known > count : names.choice.known == count;
}

bool CommentHeader::is_header(const NamesLine& names) {
  return names.choice.fault.empty() &&
         (is_list(names) || (names.choice.plain && !is_prose(names.names)));
}

bool CommentHeader::in_order(const NamesLine& names) {
  const std::array<int, 3>& column = names.choice.column;
  return column[0] == 0 && column[1] == 1 && (column[2] == 2 || column[2] < 0);
}

CommentHeader::CommentHeader(std::string_view text, std::uint64_t line)
    : text_(without_brackets(trimmed(text))), line_(line) {}

bool CommentHeader::names_plane() const {
  return text_.find_first_of(":=") == text_.npos && names().choice.column[0] >= 0;
}

}  // namespace spillway::formats
