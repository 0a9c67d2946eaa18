#include "formats/points/laz/encoding/point14_encoder.h"

#include <algorithm>
#include <cstring>

#include "formats/points/laz/coding/record_fields.h"
#include "formats/points/laz/coding/return_tables.h"
#include "formats/points/laz/coding/streaming_median.h"
#include "formats/points/laz/encoding/gps_time_encoder.h"
#include "formats/points/laz/encoding/integer_encoder.h"

namespace spillway::formats::laz {
namespace {

unsigned return_number(const std::byte* point) { return byte_at(point, kReturns) & 15U; }
unsigned return_count(const std::byte* point) { return byte_at(point, kReturns) >> 4U; }
unsigned channel_of(const std::byte* point) { return byte_at(point, core14::kFlags) >> 4U & 3U; }

/// Edge of flight line, scan direction, and the four classification flags.
unsigned six_flags(const std::byte* point) {
  const unsigned flags = byte_at(point, core14::kFlags);
  return (flags >> 6U) << 4U | (flags & 15U);
}

}  // namespace

struct Point14Encoder::Context {
  void begin(const std::byte* point) {
    masks.reset();
    channels.reset();
    counts.reset();
    numbers.reset();
    number_steps.reset();
    dx.reset();
    dy.reset();
    z.reset();
    classes.reset();
    flags.reset();
    intensities.reset();
    angles.reset();
    users.reset();
    sources.reset();
    times.reset(load<std::uint64_t>(point + core14::kGpsTime));
    dx_median.fill({});
    dy_median.fill({});
    last_z.fill(word_at(point, kZ));
    last_intensity.fill(short_at(point, kIntensity));
    std::memcpy(last.data(), point, core14::kSize);
    time_changed = false;
  }

  SymbolModels<128> masks{8};
  SymbolModels<3> channels{1};
  SymbolModels<16> counts{16};
  SymbolModels<16> numbers{16};
  SymbolModels<13> number_steps{1};
  IntegerEncoder<32> dx{2};
  IntegerEncoder<32> dy{22};
  IntegerEncoder<32> z{20};
  SymbolModels<256> classes{64};
  SymbolModels<64> flags{64};
  IntegerEncoder<16> intensities{4};
  IntegerEncoder<16> angles{2};
  SymbolModels<256> users{64};
  IntegerEncoder<16> sources{1};
  GpsTimeSequences times{true};
  std::array<StreamingMedian, 12> dx_median{};
  std::array<StreamingMedian, 12> dy_median{};
  std::array<std::uint32_t, 8> last_z{};
  std::array<std::uint16_t, 8> last_intensity{};
  std::array<std::byte, core14::kSize> last{};
  bool time_changed = false;  // at the last point
};

/// What the first layer says of a point, and the others depend on.
struct Point14Encoder::Pulse {
  ChannelStep step;
  unsigned number = 0;
  unsigned count = 0;
  bool time_changed = false;
  bool angle_changed = false;
  bool source_changed = false;

  [[nodiscard]] unsigned single() const { return count == 1 ? 1 : 0; }
  /// 3: single, 2: first, 1: last, 0: between.
  [[nodiscard]] unsigned place() const {
    return (number == 1 ? 2U : 0U) + (number >= count ? 1U : 0U);
  }
};

Point14Encoder::Point14Encoder() = default;
Point14Encoder::~Point14Encoder() = default;

void Point14Encoder::reset(const std::byte* first) {
  for (LayerStream& layer : layers_) layer.reset();
  layers_[kXyLayer].changes = true;  // both are always written
  layers_[kZLayer].changes = true;
  contexts_.reset();
  channel_ = channel_of(first);
  current_ = &contexts_.use(channel_, first);
}

ChannelStep Point14Encoder::encode(const std::byte* point) {
  const Pulse pulse = encode_xy(point);
  encode_rest(point, pulse);
  std::memcpy(current_->last.data(), point, core14::kSize);
  current_->time_changed = pulse.time_changed;
  return pulse.step;
}

Point14Encoder::Pulse Point14Encoder::encode_xy(const std::byte* point) {
  ArithmeticEncoder& stream = layers_[kXyLayer].stream;
  Context& before = *current_;
  const unsigned before_number = return_number(before.last.data());
  const unsigned mask_context = (before_number == 1 ? 1U : 0U) |
                                (before_number >= return_count(before.last.data()) ? 2U : 0U) |
                                (before.time_changed ? 4U : 0U);
  Pulse pulse;
  pulse.step = {.channel = channel_of(point), .switched = channel_of(point) != channel_};
  if (pulse.step.switched) current_ = &contexts_.use(pulse.step.channel, before.last.data());
  Context& context = *current_;
  const std::byte* last = context.last.data();

  pulse.number = return_number(point);
  pulse.count = return_count(point);
  pulse.time_changed =
      load<std::uint64_t>(point + core14::kGpsTime) != load<std::uint64_t>(last + core14::kGpsTime);
  pulse.angle_changed = short_at(point, core14::kAngle) != short_at(last, core14::kAngle);
  pulse.source_changed = short_at(point, core14::kSource) != short_at(last, core14::kSource);
  const unsigned turn = (pulse.number - return_number(last)) & 15U;
  const unsigned mask = (turn < 2     ? turn
                         : turn == 15 ? 2U
                                      : 3U) |
                        (pulse.count != return_count(last) ? 4U : 0U) |
                        (pulse.angle_changed ? 8U : 0U) | (pulse.time_changed ? 16U : 0U) |
                        (pulse.source_changed ? 32U : 0U) | (pulse.step.switched ? 64U : 0U);
  stream.symbol(mask, before.masks.at(mask_context));
  if (pulse.step.switched) {
    stream.symbol((pulse.step.channel - channel_ - 1) & 3U, before.channels.at(0));
    channel_ = pulse.step.channel;
  }
  encode_returns(pulse);

  const unsigned median =
      2U * kReturnMap16[pulse.count][pulse.number] + (pulse.time_changed ? 1U : 0U);
  const std::uint32_t dx = word_at(point, kX) - word_at(last, kX);
  context.dx.encode(stream, context.dx_median[median].get(), dx, pulse.single());
  context.dx_median[median].add(static_cast<std::int32_t>(dx));
  const std::uint32_t dy = word_at(point, kY) - word_at(last, kY);
  context.dy.encode(stream, context.dy_median[median].get(), dy,
                    pulse.single() + (std::min(context.dx.width(), 20U) & ~1U));
  context.dy_median[median].add(static_cast<std::int32_t>(dy));
  return pulse;
}

void Point14Encoder::encode_returns(const Pulse& pulse) {
  ArithmeticEncoder& stream = layers_[kXyLayer].stream;
  Context& context = *current_;
  const unsigned last_count = return_count(context.last.data());
  const unsigned last_number = return_number(context.last.data());
  if (pulse.count != last_count) stream.symbol(pulse.count, context.counts.at(last_count));
  const unsigned turn = (pulse.number - last_number) & 15U;
  if (turn < 2 || turn == 15) return;
  if (pulse.time_changed) {
    stream.symbol(pulse.number, context.numbers.at(last_number));
  } else {
    stream.symbol(turn - 2, context.number_steps.at(0));
  }
}

void Point14Encoder::encode_rest(const std::byte* point, const Pulse& pulse) {
  Context& context = *current_;
  const std::byte* last = context.last.data();
  const unsigned width = (context.dx.width() + context.dy.width()) / 2;
  std::uint32_t& last_z = context.last_z[return_level(pulse.count, pulse.number)];
  const std::uint32_t z = word_at(point, kZ);
  context.z.encode(layers_[kZLayer].stream, last_z, z,
                   pulse.single() + (std::min(width, 18U) & ~1U));
  last_z = z;

  const unsigned last_class = byte_at(last, core14::kClass);
  const unsigned class_now = byte_at(point, core14::kClass);
  layers_[kClassLayer].changes |= class_now != last_class;
  layers_[kClassLayer].stream.symbol(
      class_now, context.classes.at(2U * (last_class & 31U) + (pulse.place() == 3 ? 1U : 0U)));

  layers_[kFlagsLayer].changes |= six_flags(point) != six_flags(last);
  layers_[kFlagsLayer].stream.symbol(six_flags(point), context.flags.at(six_flags(last)));

  std::uint16_t& last_intensity =
      context.last_intensity[2 * pulse.place() + (pulse.time_changed ? 1U : 0U)];
  const std::uint16_t intensity = short_at(point, kIntensity);
  layers_[kIntensityLayer].changes |= intensity != last_intensity;
  context.intensities.encode(layers_[kIntensityLayer].stream, last_intensity, intensity,
                             pulse.place());
  last_intensity = intensity;

  if (pulse.angle_changed) {
    layers_[kAngleLayer].changes = true;
    context.angles.encode(layers_[kAngleLayer].stream, short_at(last, core14::kAngle),
                          short_at(point, core14::kAngle), pulse.time_changed ? 1 : 0);
  }

  const unsigned last_user = byte_at(last, core14::kUser);
  const unsigned user = byte_at(point, core14::kUser);
  layers_[kUserLayer].changes |= user != last_user;
  layers_[kUserLayer].stream.symbol(user, context.users.at(last_user / 4));

  if (pulse.source_changed) {
    layers_[kSourceLayer].changes = true;
    context.sources.encode(layers_[kSourceLayer].stream, short_at(last, core14::kSource),
                           short_at(point, core14::kSource), 0);
  }
  if (pulse.time_changed) {
    layers_[kGpsTimeLayer].changes = true;
    context.times.encode(layers_[kGpsTimeLayer].stream,
                         load<std::uint64_t>(point + core14::kGpsTime));
  }
}

}  // namespace spillway::formats::laz
