#include "formats/points/laz/coding/items_v1.h"

#include <algorithm>

#include "formats/points/laz/coding/record_fields.h"

namespace spillway::formats::laz {
namespace {

std::int32_t median(const std::array<std::int32_t, 3>& of) {
  return std::max(std::min(of[0], of[1]), std::min(std::max(of[0], of[1]), of[2]));
}

std::int32_t sum(std::int32_t value, std::uint32_t difference) {
  return static_cast<std::int32_t>(static_cast<std::uint32_t>(value) + difference);
}

}  // namespace

template <Keep kKeep>
void Point10V1<kKeep>::reset(const std::byte* first) {
  point_ = Point10::of_record(first);
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

template <Keep kKeep>
void Point10V1<kKeep>::decode(ArithmeticDecoder& stream, std::byte* part) {
  const KeptPart<kKeep> kept(part);
  ArithmeticDecoder local = stream;
  Point10& point = point_;
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
  if ((changed & 32U) != 0) {
    kept.put_short(kIntensity, intensity_.decode(local, kept.short_at(kIntensity), 0));
  }
  if ((changed & 16U) != 0) point.returns = local.symbol(returns_.at(point.returns));
  if ((changed & 8U) != 0) {
    point.classification = local.symbol(classification_.at(point.classification));
  }
  if ((changed & 4U) != 0) {
    const unsigned last = kept.byte_at(core10::kAngle);
    kept.put_byte(core10::kAngle, angle_.decode(local, last, width < 3 ? 1 : 0));
  }
  if ((changed & 2U) != 0) point.user = local.symbol(user_.at(point.user));
  if ((changed & 1U) != 0) {
    kept.put_short(core10::kSource, source_.decode(local, kept.short_at(core10::kSource), 0));
  }
  stream = local;
  if constexpr (kKeep == Keep::kWhole) point.store_in(part);
}

template <Keep kKeep>
void GpsTime11V1<kKeep>::reset(const std::byte* first) {
  multiple_.reset();
  zero_.reset();
  difference_.reset();
  time_ = load<std::uint64_t>(first);
  last_difference_ = 0;
  extreme_ = 0;
}

template <Keep kKeep>
void GpsTime11V1<kKeep>::decode(ArithmeticDecoder& stream, std::byte* part) {
  ArithmeticDecoder local = stream;
  bool is_raw = false;
  if (last_difference_ == 0) {
    const unsigned kind = local.symbol(zero_.at(0));
    if (kind == 1) {
      const std::uint32_t difference = difference_.decode(local, 0, 0);
      time_ = sum64(time_, difference);
      last_difference_ = static_cast<std::int32_t>(difference);
    }
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
      const std::uint32_t difference = difference_.decode(local, prediction, context);
      time_ = sum64(time_, difference);
      if (multiple == 0 || multiple == kLargest) ++extreme_;
      if (multiple == 1 || extreme_ > 3) {
        last_difference_ = static_cast<std::int32_t>(difference);
        extreme_ = 0;
      }
    }
  }
  if (is_raw) time_ = local.raw64();
  stream = local;
  KeptPart<kKeep>(part).put(0, time_);
}

template <Keep kKeep>
void Rgb12V1<kKeep>::reset(const std::byte* /*first*/) {
  used_.reset();
  bytes_.reset();
}

template <Keep kKeep>
void Rgb12V1<kKeep>::decode(ArithmeticDecoder& stream, std::byte* part) {
  const KeptPart<kKeep> kept(part);
  ArithmeticDecoder local = stream;
  const unsigned used = local.symbol(used_.at(0));
  for (unsigned i = 0; i < 6; ++i) {
    if ((used >> i & 1U) != 0) kept.put_byte(i, bytes_.decode(local, kept.byte_at(i), i));
  }
  stream = local;
}

template <Keep kKeep>
void WavePacket13<kKeep>::reset(const std::byte* /*first*/) {
  index_.reset();
  offset_kind_.reset();
  offset_.reset();
  size_.reset();
  return_point_.reset();
  direction_.reset();
  last_step_ = 0;
  last_kind_ = 0;
}

template <Keep kKeep>
void WavePacket13<kKeep>::decode(ArithmeticDecoder& stream, std::byte* part) {
  const KeptPart<kKeep> kept(part);
  ArithmeticDecoder local = stream;
  kept.put_byte(wave_packet::kIndex, local.symbol(index_.at(0)));
  auto offset = kept.template get<std::uint64_t>(wave_packet::kOffset);
  last_kind_ = local.symbol(offset_kind_.at(last_kind_));
  if (last_kind_ == 1) offset += kept.word_at(wave_packet::kSize);
  if (last_kind_ == 2) {
    last_step_ = offset_.decode(local, last_step_, 0);
    offset = sum64(offset, last_step_);
  }
  if (last_kind_ == 3) offset = local.raw64();
  kept.put(wave_packet::kOffset, offset);
  kept.put(wave_packet::kSize, size_.decode(local, kept.word_at(wave_packet::kSize), 0));
  kept.put(wave_packet::kReturnPoint,
           return_point_.decode(local, kept.word_at(wave_packet::kReturnPoint), 0));
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const std::size_t at = wave_packet::kDirection + 4 * axis;
    kept.put(at, direction_.decode(local, kept.word_at(at), axis));
  }
  stream = local;
}

template <Keep kKeep>
void ByteV1<kKeep>::decode(ArithmeticDecoder& stream, std::byte* part) {
  const KeptPart<kKeep> kept(part);
  ArithmeticDecoder local = stream;
  for (std::size_t i = 0; i < bytes_; ++i) {
    kept.put_byte(i, decoder_.decode(local, kept.byte_at(i), i));
  }
  stream = local;
}

template class Point10V1<Keep::kNeeded>;
template class Point10V1<Keep::kWhole>;
template class GpsTime11V1<Keep::kNeeded>;
template class GpsTime11V1<Keep::kWhole>;
template class Rgb12V1<Keep::kNeeded>;
template class Rgb12V1<Keep::kWhole>;
template class WavePacket13<Keep::kNeeded>;
template class WavePacket13<Keep::kWhole>;
template class ByteV1<Keep::kNeeded>;
template class ByteV1<Keep::kWhole>;

}  // namespace spillway::formats::laz
