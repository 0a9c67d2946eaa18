#include "formats/points/laz/coding/gps_times.h"

#include "formats/points/laz/coding/record_fields.h"
#include "src/error.h"

namespace spillway::formats::laz {

template <bool kLayered, Keep kKeep>
void GpsTimeDecoder<kLayered, kKeep>::reset(std::uint64_t first) {
  multiple_.reset();
  zero_.reset();
  difference_.reset();
  sequences_.fill({});
  sequences_[0].time = first;
  current_ = 0;
  newest_ = 0;
}

template <bool kLayered, Keep kKeep>
void GpsTimeDecoder<kLayered, kKeep>::decode(ArithmeticDecoder& stream) {
  constexpr unsigned kUnchanged = 511;
  constexpr unsigned kNewSequence = 512;
  constexpr unsigned kLargest = 500;   // multiple; above follow -1, -2, ...
  constexpr unsigned kSmallest = 510;  // that is, -10
  constexpr int kMostSwitches = 4;
  ArithmeticDecoder local = stream;
  for (int switches = 0;; ++switches) {
    if (switches > kMostSwitches) throw Failure("the compressed times are corrupt");
    Sequence& sequence = sequences_[current_];
    if (sequence.difference == 0) {
      const unsigned kind = local.symbol(zero_.at(0)) + kLeftOut;
      if (kind > 2) {
        current_ = (current_ + kind - 2) & 3U;
        continue;
      }
      if (kind == 1) {
        const std::uint32_t difference = difference_.decode(local, 0, 0);
        sequence.add(difference);
        sequence.difference = static_cast<std::int32_t>(difference);
        sequence.extreme = 0;
      } else if (kind == 2) {
        begin_sequence(local);
      }
      break;
    }
    unsigned multiple = local.symbol(multiple_.at(0));
    if (multiple >= kUnchanged) multiple += kLeftOut;
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
    sequence.add(difference);
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

template <bool kLayered, Keep kKeep>
void GpsTimeDecoder<kLayered, kKeep>::begin_sequence(ArithmeticDecoder& stream) {
  const auto last_high = static_cast<std::uint32_t>(sequences_[current_].time >> 32U);
  const std::uint64_t high = difference_.decode(stream, last_high, 8);
  newest_ = (newest_ + 1) & 3U;
  current_ = newest_;
  sequences_[current_] = {.time = high << 32U | stream.raw(32)};
}

template <Keep kKeep>
void GpsTime11V2<kKeep>::decode(ArithmeticDecoder& stream, std::byte* part) {
  times_.decode(stream);
  KeptPart<kKeep>(part).put(0, times_.time());
}

template class GpsTimeDecoder<false, Keep::kNeeded>;
template class GpsTimeDecoder<false, Keep::kWhole>;
template class GpsTimeDecoder<true, Keep::kWhole>;
template class GpsTime11V2<Keep::kNeeded>;
template class GpsTime11V2<Keep::kWhole>;

}  // namespace spillway::formats::laz
