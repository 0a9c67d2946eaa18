#include "formats/points/laz/source_bytes.h"

#include <algorithm>
#include <utility>

namespace spillway::detail {

std::span<const std::byte> SourceBytes::more() {
  if (put_back_ > 0) {
    const std::size_t again = std::exchange(put_back_, 0);
    left_ -= again;
    return std::span<const std::byte>(piece_).last(again);
  }
  piece_.resize(std::min<std::uint64_t>(kPiece, left_));
  reading_ = true;
  piece_.resize(source_.read(piece_));
  reading_ = false;
  left_ -= piece_.size();
  return piece_;
}

}  // namespace spillway::detail
