#include "formats/bytes/block_input.h"

#include <algorithm>
#include <cstring>
#include <span>

namespace spillway::detail {

BlockInput::BlockInput(InputSource& source)
    : source_(source),
      block_(std::clamp<std::uint64_t>(source.size().value_or(kBlock), kLargestPiece, kBlock)) {}

bool BlockInput::skip(std::uint64_t count) {
  const std::size_t here = std::min<std::uint64_t>(count, end_ - begin_);
  begin_ += here;
  return source_.skip(count - here);
}

bool BlockInput::refill(std::size_t size) {
  std::memmove(block_.data(), block_.data() + begin_, end_ - begin_);
  end_ -= begin_;
  begin_ = 0;
  end_ += source_.read(std::span(block_).subspan(end_));
  return end_ >= size;
}

}  // namespace spillway::detail
