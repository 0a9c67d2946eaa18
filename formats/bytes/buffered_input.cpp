#include "formats/bytes/buffered_input.h"

#include <algorithm>
#include <cstring>
#include <span>

namespace spillway::formats {

BufferedInput::BufferedInput(InputBytes& source)
    : source_(source),
      buffer_size_(std::clamp<std::uint64_t>(source.size().value_or(kBufferSize), kLargestRequest,
                                             kBufferSize)),
      buffer_(std::make_unique_for_overwrite<std::byte[]>(buffer_size_)) {}

bool BufferedInput::skip(std::uint64_t count) {
  const std::size_t here = std::min<std::uint64_t>(count, end_ - begin_);
  begin_ += here;
  return source_.skip(count - here);
}

bool BufferedInput::refill(std::size_t size) {
  std::memmove(buffer_.get(), buffer_.get() + begin_, end_ - begin_);
  end_ -= begin_;
  begin_ = 0;
  end_ += source_.read(std::span(buffer_.get(), buffer_size_).subspan(end_));
  return end_ >= size;
}

}  // namespace spillway::formats
