#include "tests/formats/points/laz/laz_encoder/gps_time_encoder.h"

#include <algorithm>
#include <cmath>

#include "tests/formats/points/laz/laz_encoder/fields.h"
#include "tests/formats/points/laz/laz_encoder/item_encoder.h"

namespace spillway::detail::testing {
namespace {

/// The integer nearest to step / last, within bounds.
std::int32_t multiple_of(std::int32_t step, std::int32_t last, double least, double most) {
  const double multiple = std::round(static_cast<double>(step) / last);
  return static_cast<std::int32_t>(std::clamp(multiple, least, most));
}

class GpsTimeVersion1 : public ItemEncoder {
 public:
  void encode(ArithmeticEncoder& encoder, std::string_view part, std::string_view last) override {
    const auto time = field<std::uint64_t>(part, 0);
    const std::int64_t step64 = difference64(time, field<std::uint64_t>(last, 0));
    const auto step = static_cast<std::int32_t>(step64);
    if (step_ == 0) {
      const unsigned kind = step64 == 0 ? 0 : fits_32_bits(step64) ? 1 : 2;
      encoder.symbol(kind, without_step_);
      if (kind == 2) encoder.raw64(time);
      if (kind != 1) return;
      values_.encode(encoder, 0, step, 0);
      step_ = step;
    } else if (step64 == 0) {
      encoder.symbol(511, with_step_);
    } else if (!fits_32_bits(step64)) {
      encoder.symbol(510, with_step_);
      encoder.raw64(time);
    } else {
      encode_multiple(encoder, step);
    }
  }

 private:
  void encode_multiple(ArithmeticEncoder& encoder, std::int32_t step) {
    const std::int32_t multiple = multiple_of(step, step_, 0, 509);
    encoder.symbol(static_cast<std::uint32_t>(multiple), with_step_);
    if (multiple == 1) {
      values_.encode(encoder, step_, step, 1);
    } else if (multiple == 0) {
      values_.encode(encoder, step_ / 4, step, 2);
    } else {
      values_.encode(encoder, product(multiple, step_), step,
                     multiple < 10   ? 3
                     : multiple < 50 ? 4
                                     : 5);
    }
    if (multiple == 0 || multiple == 509) ++extremes_;
    if (multiple == 1 || extremes_ > 3) {
      step_ = step;
      extremes_ = 0;
    }
  }

  SymbolModel with_step_{512};
  SymbolModel without_step_{3};
  IntegerCompressor values_{32, 6};
  std::int32_t step_ = 0;
  int extremes_ = 0;
};

class GpsTimeVersion2 : public ItemEncoder {
 public:
  explicit GpsTimeVersion2(std::uint64_t first) : sequences_(first, false) {}
  void encode(ArithmeticEncoder& encoder, std::string_view part, std::string_view) override {
    sequences_.encode(encoder, field<std::uint64_t>(part, 0));
  }

 private:
  GpsSequences sequences_;
};

}  // namespace

std::unique_ptr<ItemEncoder> make_gps_time_encoder(int version, std::string_view first) {
  if (version == 1) return std::make_unique<GpsTimeVersion1>();
  return std::make_unique<GpsTimeVersion2>(field<std::uint64_t>(first, 0));
}

GpsSequences::GpsSequences(std::uint64_t first, bool layered)
    : layered_(layered), with_step_(layered ? 515 : 516), without_step_(layered ? 5 : 6) {
  sequences_[0].time = first;
}

bool GpsSequences::reaches(std::size_t sequence, std::uint64_t time) const {
  return fits_32_bits(difference64(time, sequences_[sequence].time));
}

void GpsSequences::choose(ArithmeticEncoder& encoder, unsigned without_step, unsigned with_step) {
  if (sequences_[current_].step == 0) {
    encoder.symbol(without_step - (layered_ ? 1 : 0), without_step_);
  } else {
    encoder.symbol(with_step - (layered_ && with_step > 511 ? 1 : 0), with_step_);
  }
}

void GpsSequences::encode(ArithmeticEncoder& encoder, std::uint64_t time) {
  for (unsigned i = 0; i < 4 && !reaches(current_, time); ++i) {
    if (i == 3) {
      begin_sequence(encoder, time);
      return;
    }
    const std::size_t other = (current_ + i + 1) & 3;
    if (!reaches(other, time)) continue;
    choose(encoder, 3 + i, 513 + i);
    current_ = other;
  }
  const std::int64_t step = difference64(time, sequences_[current_].time);
  if (step == 0 && !layered_) {
    choose(encoder, 0, 511);
    return;
  }
  encode_step(encoder, static_cast<std::int32_t>(step));
  sequences_[current_].time = time;
}

void GpsSequences::encode_step(ArithmeticEncoder& encoder, std::int32_t step) {
  Sequence& sequence = sequences_[current_];
  if (sequence.step != 0) {
    encode_multiple(encoder, step);
    return;
  }
  choose(encoder, 1, 0);
  values_.encode(encoder, 0, step, 0);
  sequence.step = step;
  sequence.extremes = 0;
}

void GpsSequences::encode_multiple(ArithmeticEncoder& encoder, std::int32_t step) {
  Sequence& sequence = sequences_[current_];
  const std::int32_t multiple = multiple_of(step, sequence.step, -10, 500);
  choose(encoder, 0, static_cast<unsigned>(multiple < 0 ? 500 - multiple : multiple));
  const unsigned context = multiple == 1     ? 1
                           : multiple == 0   ? 7
                           : multiple == 500 ? 4
                           : multiple == -10 ? 6
                           : multiple < 0    ? 5
                           : multiple < 10   ? 2
                                             : 3;
  values_.encode(encoder, product(multiple, sequence.step), step, context);
  if (multiple == 1) sequence.extremes = 0;
  if (multiple == 0 || multiple == 500 || multiple == -10) note_extreme(step);
}

void GpsSequences::note_extreme(std::int32_t step) {
  Sequence& sequence = sequences_[current_];
  if (++sequence.extremes <= 3) return;
  sequence.step = step;
  sequence.extremes = 0;
}

void GpsSequences::begin_sequence(ArithmeticEncoder& encoder, std::uint64_t time) {
  choose(encoder, 2, 512);
  values_.encode(encoder, static_cast<std::int32_t>(sequences_[current_].time >> 32),
                 static_cast<std::int32_t>(time >> 32), 8);
  encoder.raw(static_cast<std::uint32_t>(time), 32);
  newest_ = (newest_ + 1) & 3;
  current_ = newest_;
  sequences_[current_] = {time, 0, 0};
}

}  // namespace spillway::detail::testing
