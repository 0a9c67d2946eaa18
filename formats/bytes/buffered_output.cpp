#include "formats/bytes/buffered_output.h"

#include <algorithm>
#include <cstring>
#include <span>

#include "formats/bytes/bytes.h"

namespace spillway::formats {

void BufferedOutput::append(std::string_view text) {
  while (!text.empty()) {
    const std::string_view piece = text.substr(0, kLargestRequest);
    std::byte* const room = reserve(piece.size());
    std::memcpy(room, piece.data(), piece.size());
    advance_to(room + piece.size());
    text.remove_prefix(piece.size());
  }
}

bool BufferedOutput::rewrite(std::uint64_t offset, std::string_view text) {
  flush();
  return file_->rewrite(offset, as_bytes_of(text));
}

void BufferedOutput::commit() {
  flush();
  file_->commit();
}

void BufferedOutput::flush() {
  if (used_ > 0) file_->write(std::span(buffer_.get(), used_));
  used_ = 0;
}

}  // namespace spillway::formats
