#include "formats/points/laz/encoding/arithmetic_encoder.h"

#include <algorithm>

namespace spillway::formats::laz {

void ArithmeticEncoder::finish(std::vector<std::byte>& out) {
  // The decoder is four bytes ahead: those that end the interval, and zeros that nobody looks at.
  const bool wide = length_ > 2 * kLeastLength;
  narrow(wide ? kLeastLength : kLeastLength >> 1U, wide ? kLeastLength >> 1U : kLeastLength >> 9U);
  out.insert(out.end(), bytes_.data(), bytes_.data() + size_);
  out.insert(out.end(), wide ? 3 : 2, std::byte{0});
  reset();
}

void ArithmeticEncoder::reset() {
  base_ = 0;
  length_ = 0xFFFFFFFF;
  size_ = 0;
}

void ArithmeticEncoder::carry() {
  std::size_t at = size_ - 1;  // the interval is a part of [0, 1): some byte takes the carry
  while (bytes_[at] == std::byte{0xFF}) bytes_[at--] = std::byte{0};
  bytes_[at] = static_cast<std::byte>(std::to_integer<unsigned>(bytes_[at]) + 1);
}

void ArithmeticEncoder::grow() { bytes_.resize(std::max<std::size_t>(1024, 2 * bytes_.size())); }

}  // namespace spillway::formats::laz
