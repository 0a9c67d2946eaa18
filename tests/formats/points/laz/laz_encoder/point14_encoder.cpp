#include "tests/formats/points/laz/laz_encoder/point14_encoder.h"

#include <algorithm>

#include "tests/formats/points/laz/laz_encoder/contexts.h"
#include "tests/formats/points/laz/laz_encoder/fields.h"
#include "tests/formats/points/laz/laz_encoder/gps_time_encoder.h"
#include "tests/formats/points/laz/laz_encoder/integer_compressor.h"

namespace spillway::detail::testing {
namespace {

unsigned return_number(std::string_view point) { return byte_at(point, kReturns) & 15; }
unsigned return_count(std::string_view point) { return byte_at(point, kReturns) >> 4; }

/// Edge of flight line, scan direction, and the four classification flags.
unsigned six_flags(std::string_view point) {
  const unsigned flags = byte_at(point, core14::kFlags);
  return (flags >> 7 << 5) | (flags >> 6 & 1) << 4 | (flags & 15);
}

template <typename T>
bool differ(std::string_view a, std::string_view b, std::size_t at) {
  return a.substr(at, sizeof(T)) != b.substr(at, sizeof(T));
}

}  // namespace

struct Point14Encoder::Context {
  explicit Context(std::string_view point)
      : last(point), gps_times(field<std::uint64_t>(point, core14::kGpsTime), true) {
    last_z.fill(field<std::int32_t>(point, kZ));
    last_intensities.fill(field<std::uint16_t>(point, kIntensity));
  }

  std::string last;
  bool gps_changed = false;

  SymbolModels masks{8, 128};
  SymbolModel channels{3};
  SymbolModels counts{16, 16};
  SymbolModels numbers{16, 16};
  SymbolModel numbers_of_pulse{13};
  IntegerCompressor x{32, 2};
  IntegerCompressor y{32, 22};
  std::array<StreamingMedian, 12> x_medians;
  std::array<StreamingMedian, 12> y_medians;
  IntegerCompressor z{32, 20};
  std::array<std::int32_t, 8> last_z{};
  SymbolModels classes{64, 256};
  SymbolModels flags{64, 64};
  IntegerCompressor intensities{16, 4};
  std::array<std::uint16_t, 8> last_intensities{};
  IntegerCompressor angles{16, 2};
  SymbolModels users{64, 256};
  IntegerCompressor sources{16, 1};
  GpsSequences gps_times;
};

/// What the first layer says of a point, and the others depend on.
struct Point14Encoder::Pulse {
  ChannelStep step;
  unsigned number = 0;
  unsigned count = 0;
  bool gps_changed = false;
  bool angle_changed = false;
  bool source_changed = false;

  [[nodiscard]] unsigned single() const { return count == 1 ? 1 : 0; }
  /// 3: single, 2: first, 1: last, 0: between.
  [[nodiscard]] unsigned place() const {
    return (number == 1 ? 2U : 0U) + (number >= count ? 1U : 0U);
  }
};

Point14Encoder::Point14Encoder(std::string_view first) : channel_(core14::channel(first)) {
  contexts_[channel_] = std::make_unique<Context>(first);
  layers_[kXyLayer].changes = true;
  layers_[kZLayer].changes = true;
}

Point14Encoder::~Point14Encoder() = default;

ChannelStep Point14Encoder::encode(std::string_view point) {
  const Pulse pulse = encode_xy(point);
  encode_rest(point, pulse);
  contexts_[channel_]->last = point;
  contexts_[channel_]->gps_changed = pulse.gps_changed;
  return pulse.step;
}

Point14Encoder::Pulse Point14Encoder::encode_xy(std::string_view point) {
  ArithmeticEncoder& encoder = layers_[kXyLayer].encoder;
  Context& before = *contexts_[channel_];
  const unsigned before_number = return_number(before.last);
  const unsigned mask_context = (before_number == 1 ? 1U : 0U) +
                                (before_number >= return_count(before.last) ? 2U : 0U) +
                                (before.gps_changed ? 4U : 0U);
  Pulse pulse;
  pulse.step.channel = core14::channel(point);
  pulse.step.switched = pulse.step.channel != channel_;
  std::unique_ptr<Context>& own = contexts_[pulse.step.channel];
  if (own == nullptr) own = std::make_unique<Context>(before.last);
  Context& context = *own;

  pulse.number = return_number(point);
  pulse.count = return_count(point);
  pulse.gps_changed = differ<std::uint64_t>(point, context.last, core14::kGpsTime);
  pulse.angle_changed = differ<std::uint16_t>(point, context.last, core14::kAngle);
  pulse.source_changed = differ<std::uint16_t>(point, context.last, core14::kSource);
  const unsigned turn = (pulse.number - return_number(context.last)) & 15;
  const unsigned mask = (turn == 0    ? 0U
                         : turn == 1  ? 1U
                         : turn == 15 ? 2U
                                      : 3U) |
                        (pulse.count != return_count(context.last) ? 4U : 0U) |
                        (pulse.angle_changed ? 8U : 0U) | (pulse.gps_changed ? 16U : 0U) |
                        (pulse.source_changed ? 32U : 0U) | (pulse.step.switched ? 64U : 0U);
  encoder.symbol(mask, before.masks[mask_context]);
  if (pulse.step.switched) {
    encoder.symbol((pulse.step.channel - channel_ - 1) & 3, before.channels);
    channel_ = pulse.step.channel;
  }
  encode_returns(encoder, context, point, pulse);

  const std::size_t median =
      2 * kReturnMap16[pulse.count][pulse.number] + (pulse.gps_changed ? 1 : 0);
  const auto dx = difference(field<std::int32_t>(point, kX), field<std::int32_t>(context.last, kX));
  context.x.encode(encoder, context.x_medians[median].get(), dx, pulse.single());
  context.x_medians[median].add(dx);
  const auto dy = difference(field<std::int32_t>(point, kY), field<std::int32_t>(context.last, kY));
  context.y.encode(encoder, context.y_medians[median].get(), dy,
                   pulse.single() + std::min(even(context.x.k()), 20U));
  context.y_medians[median].add(dy);
  return pulse;
}

void Point14Encoder::encode_returns(ArithmeticEncoder& encoder, Context& context,
                                    std::string_view point, Pulse& pulse) {
  const unsigned last_count = return_count(context.last);
  const unsigned last_number = return_number(context.last);
  if (pulse.count != last_count) {
    encoder.symbol(return_count(point), context.counts[last_count]);
  }
  const unsigned turn = (pulse.number - last_number) & 15;
  if (turn < 2 || turn == 15) return;
  if (pulse.gps_changed) {
    encoder.symbol(pulse.number, context.numbers[last_number]);
  } else {
    encoder.symbol(turn - 2, context.numbers_of_pulse);
  }
}

void Point14Encoder::encode_rest(std::string_view point, const Pulse& pulse) {
  Context& context = *contexts_[channel_];
  const std::string_view last = context.last;
  const unsigned k = (context.x.k() + context.y.k()) / 2;
  std::int32_t& last_z = context.last_z[return_level(pulse.count, pulse.number)];
  const auto z = field<std::int32_t>(point, kZ);
  context.z.encode(layers_[kZLayer].encoder, last_z, z, pulse.single() + std::min(even(k), 18U));
  last_z = z;

  const unsigned last_class = byte_at(last, core14::kClass);
  layers_[kClassLayer].changes |= byte_at(point, core14::kClass) != last_class;
  layers_[kClassLayer].encoder.symbol(
      byte_at(point, core14::kClass),
      context.classes[2 * (last_class & 31) + (pulse.place() == 3 ? 1 : 0)]);

  layers_[kFlagsLayer].changes |= six_flags(point) != six_flags(last);
  layers_[kFlagsLayer].encoder.symbol(six_flags(point), context.flags[six_flags(last)]);

  std::uint16_t& last_intensity =
      context.last_intensities[2 * pulse.place() + (pulse.gps_changed ? 1 : 0)];
  const auto intensity = field<std::uint16_t>(point, kIntensity);
  layers_[kIntensityLayer].changes |= intensity != last_intensity;
  context.intensities.encode(layers_[kIntensityLayer].encoder, last_intensity, intensity,
                             pulse.place());
  last_intensity = intensity;

  layers_[kAngleLayer].changes |= pulse.angle_changed;
  if (pulse.angle_changed) {
    context.angles.encode(layers_[kAngleLayer].encoder, field<std::int16_t>(last, core14::kAngle),
                          field<std::int16_t>(point, core14::kAngle), pulse.gps_changed ? 1 : 0);
  }

  const unsigned last_user = byte_at(last, core14::kUser);
  layers_[kUserLayer].changes |= byte_at(point, core14::kUser) != last_user;
  layers_[kUserLayer].encoder.symbol(byte_at(point, core14::kUser), context.users[last_user / 4]);

  layers_[kSourceLayer].changes |= pulse.source_changed;
  if (pulse.source_changed) {
    context.sources.encode(layers_[kSourceLayer].encoder,
                           field<std::uint16_t>(last, core14::kSource),
                           field<std::uint16_t>(point, core14::kSource), 0);
  }

  layers_[kGpsTimeLayer].changes |= pulse.gps_changed;
  if (pulse.gps_changed) {
    context.gps_times.encode(layers_[kGpsTimeLayer].encoder,
                             field<std::uint64_t>(point, core14::kGpsTime));
  }
}

}  // namespace spillway::detail::testing
