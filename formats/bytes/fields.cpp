#include "formats/bytes/fields.h"

#include <cctype>
#include <charconv>

#include "formats/bytes/line_reader.h"

namespace spillway::formats {
namespace {

bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\r'; }

/// All of `text` as a T, a leading plus sign allowed.
template <typename T>
std::optional<T> parse(std::string_view text) {
  if (text.size() > 1 && text[0] == '+' && text[1] != '-') text.remove_prefix(1);
  T value{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return value;
}

}  // namespace

bool Fields::at_end() {
  while (!rest_.empty() && is_blank(rest_.front())) rest_.remove_prefix(1);
  return rest_.empty();
}

std::string_view Fields::word() {
  if (at_end()) return {};
  std::size_t length = 1;
  while (length < rest_.size() && !is_blank(rest_[length])) ++length;
  const std::string_view field = rest_.substr(0, length);
  rest_.remove_prefix(length);
  return field;
}

std::optional<double> Fields::number() { return parse<double>(word()); }

std::optional<std::int64_t> Fields::integer() { return parse<std::int64_t>(word()); }

std::optional<std::uint64_t> Fields::count() { return parse_count(word()); }

std::optional<std::uint64_t> parse_count(std::string_view text) {
  return parse<std::uint64_t>(text);
}

bool next_fields(LineReader& lines, Fields& fields) {
  std::string_view line;
  while (lines.next(line)) {
    fields = Fields(line);
    if (!fields.at_end()) return true;
    lines.pass_over();
  }
  return false;
}

bool begins_with_word(std::string_view first_bytes, std::string_view word) {
  return first_bytes.starts_with(word) &&
         (first_bytes.size() == word.size() ||
          std::isspace(static_cast<unsigned char>(first_bytes[word.size()])) != 0);
}

}  // namespace spillway::formats
