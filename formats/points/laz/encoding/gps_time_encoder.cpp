#include "formats/points/laz/encoding/gps_time_encoder.h"

#include "formats/points/laz/coding/record_fields.h"
#include "formats/points/laz/encoding/item_encoder.h"

namespace spillway::formats::laz {
namespace {

constexpr int kLargest = 500;          // multiple of a step; above follow -1, -2, ...
constexpr int kSmallest = -10;         // multiple
constexpr unsigned kUnchanged = 511;   // the first symbol after those of multiples
constexpr unsigned kMostExtremes = 3;  // that a step outlives

/// The integer nearest to step / last, within bounds. In single precision as in other encoders, so
/// that equal times become equal bytes.
int multiple_of(std::int32_t step, std::int32_t last) {
  const float multiple = static_cast<float>(step) / static_cast<float>(last);
  if (multiple >= kLargest) return kLargest;
  if (multiple <= kSmallest) return kSmallest;
  return static_cast<int>(multiple >= 0 ? multiple + 0.5F : multiple - 0.5F);
}

class GpsTimeEncoder final : public ItemEncoder {
 public:
  void reset(const std::byte* first) override { sequences_.reset(load<std::uint64_t>(first)); }

  void encode(ArithmeticEncoder& stream, const std::byte* part,
              const std::byte* /*last*/) override {
    sequences_.encode(stream, load<std::uint64_t>(part));
  }

 private:
  GpsTimeSequences sequences_{false};
};

}  // namespace

std::unique_ptr<ItemEncoder> make_gps_time_encoder() { return std::make_unique<GpsTimeEncoder>(); }

void GpsTimeSequences::reset(std::uint64_t first) {
  sequences_.fill({});
  sequences_[0].time = first;
  current_ = 0;
  newest_ = 0;
  with_step_.reset();
  without_step_.reset();
  differences_.reset();
}

bool GpsTimeSequences::reaches(std::size_t sequence, std::uint64_t time) const {
  return fits_32_bits(difference64(time, sequences_[sequence].time));
}

void GpsTimeSequences::choose(ArithmeticEncoder& stream, unsigned without_step,
                              unsigned with_step) {
  if (sequences_[current_].step == 0) {
    if (layered_) {
      stream.symbol(without_step - 1, without_step_.at(0, 5));
    } else {
      stream.symbol(without_step, without_step_.at(0));
    }
  } else if (layered_) {
    stream.symbol(with_step - (with_step > kUnchanged ? 1 : 0), with_step_.at(0, 515));
  } else {
    stream.symbol(with_step, with_step_.at(0));
  }
}

void GpsTimeSequences::encode(ArithmeticEncoder& stream, std::uint64_t time) {
  if (!reaches(current_, time)) {
    unsigned ahead = 1;
    while (ahead < 4 && !reaches((current_ + ahead) & 3U, time)) ++ahead;
    if (ahead == 4) {
      begin_sequence(stream, time);
      return;
    }
    choose(stream, 2 + ahead, kUnchanged + 1 + ahead);
    current_ = (current_ + ahead) & 3U;
  }
  const std::int64_t step = difference64(time, sequences_[current_].time);
  if (step == 0 && !layered_) {
    choose(stream, 0, kUnchanged);
    return;
  }
  encode_step(stream, static_cast<std::int32_t>(step));
  sequences_[current_].time = time;
}

void GpsTimeSequences::encode_step(ArithmeticEncoder& stream, std::int32_t step) {
  Sequence& sequence = sequences_[current_];
  if (sequence.step != 0) {
    encode_multiple(stream, step);
    return;
  }
  choose(stream, 1, 0);
  differences_.encode(stream, 0, static_cast<std::uint32_t>(step), 0);
  sequence.step = step;
  sequence.extreme = 0;
}

void GpsTimeSequences::encode_multiple(ArithmeticEncoder& stream, std::int32_t step) {
  Sequence& sequence = sequences_[current_];
  const int multiple = multiple_of(step, sequence.step);
  choose(stream, 0, static_cast<unsigned>(multiple < 0 ? kLargest - multiple : multiple));
  const std::size_t context = multiple == 1           ? 1
                              : multiple == 0         ? 7
                              : multiple == kLargest  ? 4
                              : multiple == kSmallest ? 6
                              : multiple < 0          ? 5
                              : multiple < 10         ? 2
                                                      : 3;
  differences_.encode(
      stream, static_cast<std::uint32_t>(multiple) * static_cast<std::uint32_t>(sequence.step),
      static_cast<std::uint32_t>(step), context);
  if (multiple == 1) {
    sequence.extreme = 0;
  } else if ((multiple == 0 || multiple == kLargest || multiple == kSmallest) &&
             ++sequence.extreme > kMostExtremes) {
    sequence.step = step;
    sequence.extreme = 0;
  }
}

void GpsTimeSequences::begin_sequence(ArithmeticEncoder& stream, std::uint64_t time) {
  choose(stream, 2, kUnchanged + 1);
  differences_.encode(stream, static_cast<std::uint32_t>(sequences_[current_].time >> 32U),
                      static_cast<std::uint32_t>(time >> 32U), 8);
  stream.raw(static_cast<std::uint32_t>(time), 32);
  newest_ = (newest_ + 1) & 3U;
  current_ = newest_;
  sequences_[current_] = {.time = time};
}

}  // namespace spillway::formats::laz
