#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

#include "src/rooms.h"

namespace spillway::formats {

/// The fields of one line of a text mesh, separated by blanks and tabs.
class Fields {
 public:
  explicit Fields(std::string_view line) : rest_(line) {}

  /// Whether no field is left.
  [[nodiscard]] bool at_end();

  /// The next field; empty at the end.
  std::string_view word();

  /// The next field as a double, rounded to nearest; nothing if it is missing or no number.
  std::optional<double> number();

  /// The next field as a signed or unsigned integer; nothing if it is missing, no integer or out of
  /// the type's range.
  std::optional<std::int64_t> integer();
  std::optional<std::uint64_t> count();

 private:
  std::string_view rest_;
};

class LineReader;

/// Sets `fields` to those of the next line that is not blank; false at the end.
bool next_fields(LineReader& lines, Fields& fields);

/// Whether a file's first bytes are this word, and nothing that makes it longer.
bool begins_with_word(std::string_view first_bytes, std::string_view word);

/// All of `text` as an unsigned integer, or nothing.
std::optional<std::uint64_t> parse_count(std::string_view text);

}  // namespace spillway::formats
