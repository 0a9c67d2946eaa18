#include "formats/points/laz/file_bytes.h"

#include <algorithm>
#include <utility>

namespace spillway::formats {

std::span<const std::byte> FileBytes::more() {
  if (put_back_ > 0) {
    const std::size_t again = std::exchange(put_back_, 0);
    left_ -= again;
    return std::span<const std::byte>(buffer_).last(again);
  }
  buffer_.resize(std::min<std::uint64_t>(kBufferSize, left_));
  reading_ = true;
  buffer_.resize(source_.read(buffer_));
  reading_ = false;
  left_ -= buffer_.size();
  return buffer_;
}

bool FileBytes::at_end() {
  if (put_back_ > 0) return false;
  if (left_ == 0) return true;
  reading_ = true;
  const bool none = source_.peek(1).empty();
  reading_ = false;
  return none;
}

}  // namespace spillway::formats
