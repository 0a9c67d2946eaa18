#include "formats/points/laz/coding/items_v2.h"

#include <algorithm>

#include "formats/points/laz/coding/return_tables.h"
#include "src/error.h"

namespace spillway::detail::laz {

void Point10V2::reset() {
  changed_.reset();
  returns_.reset();
  classification_.reset();
  user_.reset();
  angle_.reset();
  intensity_.reset();
  source_.reset();
  dx_.reset();
  dy_.reset();
  z_.reset();
  dx_median_.fill({});
  dy_median_.fill({});
  last_z_.fill(0);
}

void Point10V2::decode(ArithmeticDecoder& stream) {
  ArithmeticDecoder local = stream;
  const unsigned changed = local.symbol(changed_.at(0));
  if ((changed & 32U) != 0) point.returns = local.symbol(returns_.at(point.returns));
  const unsigned number = point.returns & 7U;
  const unsigned returns = point.returns >> 3U & 7U;
  const unsigned map = kReturnMap8[returns][number];
  const unsigned single = returns == 1 ? 1 : 0;
  if ((changed & 16U) != 0) intensity_.decode(local, 0, std::min(map, 3U));
  if ((changed & 8U) != 0) {
    point.classification = local.symbol(classification_.at(point.classification));
  }
  if ((changed & 4U) != 0) local.symbol(angle_.at(point.returns >> 6U & 1U));
  if ((changed & 2U) != 0) point.user = local.symbol(user_.at(point.user));
  if ((changed & 1U) != 0) source_.decode(local, 0, 0);

  const std::uint32_t dx = dx_.decode(local, dx_median_[map].get(), single);
  point.x = static_cast<std::int32_t>(point.x + dx);
  dx_median_[map].add(static_cast<std::int32_t>(dx));
  const unsigned dy_context = single + (std::min(dx_.width(), 20U) & ~1U);
  const std::uint32_t dy = dy_.decode(local, dy_median_[map].get(), dy_context);
  point.y = static_cast<std::int32_t>(point.y + dy);
  dy_median_[map].add(static_cast<std::int32_t>(dy));
  const unsigned z_context = single + (std::min((dx_.width() + dy_.width()) / 2, 18U) & ~1U);
  std::int32_t& last_z = last_z_[return_level(returns, number)];
  last_z = static_cast<std::int32_t>(z_.decode(local, last_z, z_context));
  point.z = last_z;
  stream = local;
}

void GpsTime11V2::reset() {
  multiple_.reset();
  zero_.reset();
  difference_.reset();
  sequences_.fill({});
  current_ = 0;
  newest_ = 0;
}

void GpsTime11V2::decode(ArithmeticDecoder& stream) {
  constexpr unsigned kUnchanged = 511;
  constexpr unsigned kNewSequence = 512;
  constexpr unsigned kLargest = 500;   // multiple; above follow -1, -2, ...
  constexpr unsigned kSmallest = 510;  // that is, -10
  constexpr int kMostSwitches = 4;
  ArithmeticDecoder local = stream;
  for (int switches = 0;; ++switches) {
    if (switches > kMostSwitches) throw Error("the compressed times are corrupt");
    Sequence& sequence = sequences_[current_];
    if (sequence.difference == 0) {
      const unsigned kind = local.symbol(zero_.at(0));
      if (kind > 2) {
        current_ = (current_ + kind - 2) & 3U;
        continue;
      }
      if (kind == 1) {
        sequence.difference = static_cast<std::int32_t>(difference_.decode(local, 0, 0));
        sequence.extreme = 0;
      } else if (kind == 2) {
        begin_sequence(local);
      }
      break;
    }
    const unsigned multiple = local.symbol(multiple_.at(0));
    if (multiple == kUnchanged) break;
    if (multiple > kNewSequence) {
      current_ = (current_ + multiple - kNewSequence) & 3U;
      continue;
    }
    if (multiple == kNewSequence) {
      begin_sequence(local);
      break;
    }
    const std::uint32_t factor = multiple <= kLargest ? multiple : kLargest - multiple;
    const std::size_t context = multiple == 1          ? 1
                                : multiple == 0        ? 7
                                : multiple < 10        ? 2
                                : multiple < kLargest  ? 3
                                : multiple == kLargest ? 4
                                : multiple < kSmallest ? 5
                                                       : 6;
    const std::uint32_t difference = difference_.decode(
        local, factor * static_cast<std::uint32_t>(sequence.difference), context);
    if (multiple == 1) {
      sequence.extreme = 0;
    } else if (multiple == 0 || multiple == kLargest || multiple == kSmallest) {
      if (++sequence.extreme > 3) {
        sequence.difference = static_cast<std::int32_t>(difference);
        sequence.extreme = 0;
      }
    }
    break;
  }
  stream = local;
}

void GpsTime11V2::begin_sequence(ArithmeticDecoder& stream) {
  difference_.decode(stream, 0, 8);
  stream.raw(32);
  newest_ = (newest_ + 1) & 3U;
  current_ = newest_;
  sequences_[current_] = {};
}

void Rgb12V2::reset() {
  used_.reset();
  differences_.reset();
}

void Rgb12V2::decode(ArithmeticDecoder& stream) {
  constexpr unsigned kColoured = 64;
  ArithmeticDecoder local = stream;
  const unsigned used = local.symbol(used_.at(0));
  if ((used & 1U) != 0) local.symbol(differences_.at(0));
  if ((used & 2U) != 0) local.symbol(differences_.at(1));
  if ((used & kColoured) != 0) {
    // Low bytes of green and blue, then the high ones.
    for (const unsigned i : {2U, 4U, 3U, 5U}) {
      if ((used >> i & 1U) != 0) local.symbol(differences_.at(i));
    }
  }
  stream = local;
}

void ByteV2::decode(ArithmeticDecoder& stream) {
  ArithmeticDecoder local = stream;
  for (std::size_t i = 0; i < bytes_; ++i) local.symbol(differences_.at(i));
  stream = local;
}

}  // namespace spillway::detail::laz
