#pragma once
// Fields in quotes that have line ends in them (RFC 4180).

#include <cstddef>
#include <string>
#include <string_view>

#include "formats/bytes/line_reader.h"
#include "formats/points/text/text_columns.h"

namespace spillway::formats {

/// Looks for fields in quotes that go on in the next line. Where blanks separate, or nothing, none
/// does.
class QuoteScan {
 public:
  /// The most bytes of a line that ends so.
  static constexpr std::size_t kLongest = std::size_t{64} << 10;

  explicit QuoteScan(Separator separator) : separator_(separator) {}

  /// Whether a line ends within quotes. The next call is for the same line with the one that follows
  /// it: what has been looked at is not looked at again.
  [[nodiscard]] bool goes_on(std::string_view line);

  /// Whether something else than a separator follows the last quote of a field of several lines: so
  /// its first quote was none.
  [[nodiscard]] bool is_broken() const { return is_broken_; }

 private:
  enum class Place { kFieldBegin, kPlain, kQuoted, kBehindQuotes, kComment };

  Separator separator_;
  Place place_ = Place::kFieldBegin;
  std::size_t at_ = 0;
  bool is_of_lines_ = false;  // the last field in quotes
  bool is_broken_ = false;
};

/// Makes a line, which `lines` gave last, longer as long as it ends within quotes. Returns why that
/// cannot be, to be put behind the line's name; empty if it can.
std::string complete_in_quotes(LineReader& lines, std::string_view& line, Separator separator);

}  // namespace spillway::formats
