#include "formats/bytes/line_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <span>
#include <utility>

#include "src/error.h"

namespace spillway::formats {

bool LineReader::next(std::string_view& line) {
  if (!read_line(line, 0)) return false;
  number_ += std::exchange(lines_in_line_, 1);
  return true;
}

bool LineReader::extend(std::string_view& line) {
  const std::size_t before = position() - line_begin_;
  begin_ -= before;
  if (!read_line(line, before)) {
    line = {buffer_.get() + begin_, before};
    if (line.ends_with('\n')) line.remove_suffix(1);
    begin_ += before;
    return false;
  }
  ++lines_in_line_;
  return true;
}

bool LineReader::read_line(std::string_view& line, std::size_t searched) {
  const std::size_t before = searched;
  const char* line_end = nullptr;
  while (true) {
    const char* from = buffer_.get() + begin_ + searched;
    const std::size_t unsearched = end_ - begin_ - searched;
    line_end = static_cast<const char*>(std::memchr(from, '\n', unsearched));
    if (line_end != nullptr) break;
    searched = end_ - begin_;
    if (!refill()) break;
  }
  if (line_end == nullptr && begin_ + before == end_) return false;
  line_begin_ = position();
  const char* const start = buffer_.get() + begin_;
  const std::size_t length = line_end != nullptr ? line_end - start : end_ - begin_;
  begin_ += length + (line_end != nullptr ? 1 : 0);
  line = {start, length};
  if (line.ends_with('\r')) line.remove_suffix(1);
  if (line_begin_ == 0 && line.starts_with("\xef\xbb\xbf")) line.remove_prefix(3);
  return true;
}

void LineReader::pass_over() {
  if (line_begin_ != gap_end_) gap_begin_ = line_begin_;
  gap_end_ = position();
  if (gap_end_ - gap_begin_ > kLongestGap) {
    throw BadInput(file_.name(),
                   fmt::format("before {} are more than {} bytes of lines with nothing to read; "
                               "see what writes this",
                               line_name(), kLongestGap),
                   place());
  }
}

void LineReader::seek(std::uint64_t byte) {
  // A line begins after the end of another one, so the byte before tells.
  const std::uint64_t from = byte - (byte > 0 ? 1 : 0);
  file_.seek(from);
  buffer_begin_ = from;
  begin_ = end_ = 0;
  numbered_ = false;
  std::string_view passed;
  if (byte > 0) next(passed);
}

std::string LineReader::name_of(const FilePlace& line) {
  return fmt::format("{} {}", line.unit == PlaceUnit::kLine ? "line" : "the line at byte",
                     line.number);
}

bool LineReader::refill() {
  std::memmove(buffer_.get(), buffer_.get() + begin_, end_ - begin_);
  end_ -= begin_;
  buffer_begin_ += begin_;
  begin_ = 0;
  const std::span<char> space = std::span(buffer_.get(), kBufferSize).subspan(end_);
  if (space.empty()) {
    const bool is_extended = number_ > 0 && position() == line_begin_;
    const FilePlace line =
        place_of_line(is_extended ? number_ : number_ + lines_in_line_, position());
    throw BadInput(
        file_.name(),
        fmt::format("{} is longer than {} bytes; this is not text", name_of(line), kLongestLine),
        line);
  }
  const std::size_t got = file_.read(std::as_writable_bytes(space));
  has_quotes_ = has_quotes_ || std::memchr(space.data(), '"', got) != nullptr;
  end_ += got;
  return got > 0;
}

bool looks_like_text(std::string_view bytes) {
  return std::none_of(bytes.begin(), bytes.end(), [](unsigned char c) {
    return c == 0x7f || (c < ' ' && c != '\t' && c != '\n' && c != '\r' && c != '\f');
  });
}

std::string quoted(std::string_view text) {
  constexpr std::size_t kLongest = 60;
  std::string result = "\"";
  for (const char c : text.substr(0, kLongest)) result += c >= ' ' && c <= '~' ? c : '?';
  return result + (text.size() > kLongest ? "...\"" : "\"");
}

}  // namespace spillway::formats
