#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>

#include "formats/disk/file_system.h"
#include "src/error.h"

namespace spillway::formats {

/// Lines of a text file, read in big chunks. A line ends with LF or CR LF or the end of the file; a
/// UTF-8 byte order mark before the first one is dropped. Memory is constant: a line longer than
/// kLongestLine is an Failure.
class LineReader {
 public:
  static constexpr std::size_t kLongestLine = std::size_t{1} << 20;
  static constexpr std::uint64_t kLongestGap = std::uint64_t{16} << 20;

  /// `file` must outlive the reader.
  explicit LineReader(InputFile& file) : file_(file) {}

  /// Sets `line` to the next one without its end, valid until the next call; false at the end.
  bool next(std::string_view& line);

  /// Makes that line longer by the next one, with the line end between them; it keeps its number.
  /// False, and the line stays what it is, if there is none.
  bool extend(std::string_view& line);

  /// Whether a double quote may have come so far.
  [[nodiscard]] bool has_quotes() const { return has_quotes_; }

  /// What has been read of the file after that line: most of the first MiB once next() has given
  /// the first line. Valid until the next call.
  [[nodiscard]] std::string_view unread() const { return {buffer_.get() + begin_, end_ - begin_}; }

  /// Says that the line which next() gave last holds nothing, so that input of nothing else comes
  /// to an end: throws Failure if more than kLongestGap bytes of such lines have followed one
  /// another.
  void pass_over();

  /// Makes next() go on with the first line that begins at that byte or after it. Lines have no
  /// numbers from then on. Only for a file that can seek.
  void seek(std::uint64_t byte);

  [[nodiscard]] bool numbered() const { return numbered_; }

  /// Number of the line that next() gave last, counted from 1.
  [[nodiscard]] std::uint64_t number() const { return number_; }

  /// The byte where that line begins, and where the next one does.
  [[nodiscard]] std::uint64_t line_begin() const { return line_begin_; }
  [[nodiscard]] std::uint64_t position() const { return buffer_begin_ + begin_; }

  /// That line as messages call it: "line 7", or without numbers "the line at byte 123".
  [[nodiscard]] std::string line_name() const { return name_of(place()); }

  /// That line, or without numbers the byte where it begins.
  [[nodiscard]] FilePlace place() const { return place_of_line(number_, line_begin_); }

 private:
  [[nodiscard]] FilePlace place_of_line(std::uint64_t number, std::uint64_t byte) const {
    return numbered_ ? at_line(number) : at_byte(byte);
  }
  static std::string name_of(const FilePlace& line);

  /// Sets `line` to what there is from the first unread byte on, up to an end that is looked for after
  /// the first `searched` bytes; false if there is no more than these.
  bool read_line(std::string_view& line, std::size_t searched);

  /// Moves the unread bytes to the front and fills up after them; false if there was nothing more.
  bool refill();

  InputFile& file_;
  static constexpr std::size_t kBufferSize = kLongestLine + 2;
  // Not cleared: what is never filled takes no memory.
  std::unique_ptr<char[]> buffer_ = std::make_unique_for_overwrite<char[]>(kBufferSize);
  std::size_t begin_ = 0;  // the unread bytes are [begin_, end_)
  std::size_t end_ = 0;
  std::uint64_t buffer_begin_ = 0;  // byte of the file where the buffer begins
  std::uint64_t line_begin_ = 0;
  std::uint64_t gap_begin_ = 0;  // the last lines that were passed over are [gap_begin_, gap_end_)
  std::uint64_t gap_end_ = 0;
  std::uint64_t number_ = 0;
  std::uint64_t lines_in_line_ = 1;  // 2 and more: it was extended
  bool has_quotes_ = false;
  bool numbered_ = true;
};

/// Whether these bytes may be of a text: no control characters but white space.
bool looks_like_text(std::string_view bytes);

/// Text for messages: at most some 60 characters, nothing that is not printable, in quotes.
std::string quoted(std::string_view text);

}  // namespace spillway::formats
