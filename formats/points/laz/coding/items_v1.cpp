#include "formats/points/laz/coding/items_v1.h"

#include <algorithm>

namespace spillway::detail::laz {
namespace {

std::int32_t median(const std::array<std::int32_t, 3>& of) {
  return std::max(std::min(of[0], of[1]), std::min(std::max(of[0], of[1]), of[2]));
}

std::int32_t sum(std::int32_t value, std::uint32_t difference) {
  return static_cast<std::int32_t>(static_cast<std::uint32_t>(value) + difference);
}

}  // namespace

void Point10V1::reset() {
  changed_.reset();
  returns_.reset();
  classification_.reset();
  user_.reset();
  dx_.reset();
  dy_.reset();
  z_.reset();
  intensity_.reset();
  angle_.reset();
  source_.reset();
  last_dx_.fill(0);
  last_dy_.fill(0);
}

void Point10V1::decode(ArithmeticDecoder& stream) {
  ArithmeticDecoder local = stream;
  const auto dx = static_cast<std::int32_t>(dx_.decode(local, median(last_dx_), 0));
  const std::size_t dy_context = std::min(dx_.width(), 19U);
  const auto dy = static_cast<std::int32_t>(dy_.decode(local, median(last_dy_), dy_context));
  const unsigned width = (dx_.width() + dy_.width()) / 2;
  point.x = sum(point.x, dx);
  point.y = sum(point.y, dy);
  point.z = static_cast<std::int32_t>(z_.decode(local, point.z, std::min(width, 19U)));
  last_dx_[oldest_] = dx;
  last_dy_[oldest_] = dy;
  oldest_ = oldest_ == 2 ? 0 : oldest_ + 1;

  const unsigned changed = local.symbol(changed_.at(0));
  if ((changed & 32U) != 0) intensity_.decode(local, 0, 0);
  if ((changed & 16U) != 0) point.returns = local.symbol(returns_.at(point.returns));
  if ((changed & 8U) != 0) {
    point.classification = local.symbol(classification_.at(point.classification));
  }
  if ((changed & 4U) != 0) angle_.decode(local, 0, width < 3 ? 1 : 0);
  if ((changed & 2U) != 0) point.user = local.symbol(user_.at(point.user));
  if ((changed & 1U) != 0) source_.decode(local, 0, 0);
  stream = local;
}

void GpsTime11V1::reset() {
  multiple_.reset();
  zero_.reset();
  difference_.reset();
  last_difference_ = 0;
  extreme_ = 0;
}

void GpsTime11V1::decode(ArithmeticDecoder& stream) {
  ArithmeticDecoder local = stream;
  bool is_raw = false;
  if (last_difference_ == 0) {
    const unsigned kind = local.symbol(zero_.at(0));
    if (kind == 1) last_difference_ = static_cast<std::int32_t>(difference_.decode(local, 0, 0));
    is_raw = kind == 2;
  } else {
    constexpr unsigned kRaw = 510;
    constexpr unsigned kLargest = kRaw - 1;
    const unsigned multiple = local.symbol(multiple_.at(0));
    is_raw = multiple == kRaw;
    if (multiple < kRaw) {
      const std::uint32_t prediction =
          multiple == 0 ? static_cast<std::uint32_t>(last_difference_ / 4)
                        : multiple * static_cast<std::uint32_t>(last_difference_);
      const std::size_t context = multiple == 0   ? 2
                                  : multiple == 1 ? 1
                                  : multiple < 10 ? 3
                                  : multiple < 50 ? 4
                                                  : 5;
      const auto difference =
          static_cast<std::int32_t>(difference_.decode(local, prediction, context));
      if (multiple == 0 || multiple == kLargest) ++extreme_;
      if (multiple == 1 || extreme_ > 3) {
        last_difference_ = difference;
        extreme_ = 0;
      }
    }
  }
  if (is_raw) {
    for (int i = 0; i < 4; ++i) local.raw(16);
  }
  stream = local;
}

void Rgb12V1::reset() {
  used_.reset();
  bytes_.reset();
}

void Rgb12V1::decode(ArithmeticDecoder& stream) {
  ArithmeticDecoder local = stream;
  const unsigned used = local.symbol(used_.at(0));
  for (unsigned i = 0; i < 6; ++i) {
    if ((used >> i & 1U) != 0) bytes_.decode(local, 0, i);
  }
  stream = local;
}

void WavePacket13::reset() {
  index_.reset();
  offset_kind_.reset();
  offset_.reset();
  size_.reset();
  return_point_.reset();
  direction_.reset();
  last_kind_ = 0;
}

void WavePacket13::decode(ArithmeticDecoder& stream) {
  ArithmeticDecoder local = stream;
  local.symbol(index_.at(0));
  last_kind_ = local.symbol(offset_kind_.at(last_kind_));
  if (last_kind_ == 2) offset_.decode(local, 0, 0);
  if (last_kind_ == 3) {
    for (int i = 0; i < 4; ++i) local.raw(16);
  }
  size_.decode(local, 0, 0);
  return_point_.decode(local, 0, 0);
  for (std::size_t axis = 0; axis < 3; ++axis) direction_.decode(local, 0, axis);
  stream = local;
}

void ByteV1::decode(ArithmeticDecoder& stream) {
  ArithmeticDecoder local = stream;
  for (std::size_t i = 0; i < bytes_; ++i) decoder_.decode(local, 0, i);
  stream = local;
}

}  // namespace spillway::detail::laz
