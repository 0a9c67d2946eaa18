#include "formats/points/laz/coding/point14_other_layers.h"

#include "formats/points/laz/coding/record_fields.h"

namespace spillway::formats::laz {
namespace {

enum LayerIndex : unsigned { kIntensityLayer, kAngleLayer, kUserLayer, kSourceLayer, kTimeLayer };

}  // namespace

void Point14OtherLayers::Context::begin(const Fields& first) {
  intensity.reset();
  angle.reset();
  user.reset();
  source.reset();
  time.reset(first.time);
  last_intensity.fill(first.intensity);
  last = first;
}

std::span<const std::byte> Point14OtherLayers::begin(const std::byte* first,
                                                     std::span<const std::byte> layers,
                                                     std::span<const std::size_t, kLayers> sizes) {
  for (std::size_t i = 0; i < kLayers; ++i) layers = layers_[i].begin(layers, sizes[i]);
  contexts_.reset();
  current_ = &contexts_.use(Point14::of_record(first).channel,
                            Fields{.intensity = load<std::uint16_t>(first + kIntensity),
                                   .angle = load<std::uint16_t>(first + core14::kAngle),
                                   .user = load<std::uint8_t>(first + core14::kUser),
                                   .source = load<std::uint16_t>(first + core14::kSource),
                                   .time = load<std::uint64_t>(first + core14::kGpsTime)});
  return layers;
}

void Point14OtherLayers::decode(const Point14& point, const Point14Changes& changes,
                                std::byte* record) {
  if (changes.channel) current_ = &contexts_.use(point.channel, current_->last);
  Context& context = *current_;
  Fields& fields = context.last;
  const unsigned time_changed = changes.time ? 1 : 0;
  if (layers_[kIntensityLayer].present) {
    // 3: single, 2: first, 1: last, 0: between.
    const unsigned place = (point.return_number == 1 ? 2U : 0U) +
                           (point.return_number >= point.return_count ? 1U : 0U);
    std::uint16_t& intensity = context.last_intensity[2 * place + time_changed];
    intensity = context.intensity.decode(layers_[kIntensityLayer].stream, intensity, place);
    fields.intensity = intensity;
  }
  if (layers_[kAngleLayer].present && changes.angle) {
    fields.angle = context.angle.decode(layers_[kAngleLayer].stream, fields.angle, time_changed);
  }
  if (layers_[kUserLayer].present) {
    fields.user = layers_[kUserLayer].stream.symbol(context.user.at(fields.user / 4));
  }
  if (layers_[kSourceLayer].present && changes.source) {
    fields.source = context.source.decode(layers_[kSourceLayer].stream, fields.source, 0);
  }
  if (layers_[kTimeLayer].present && changes.time) {
    context.time.decode(layers_[kTimeLayer].stream);
    fields.time = context.time.time();
  }
  store(record + kIntensity, fields.intensity);
  store(record + core14::kUser, fields.user);
  store(record + core14::kAngle, fields.angle);
  store(record + core14::kSource, fields.source);
  store(record + core14::kGpsTime, fields.time);
}

void Point14OtherLayers::end() const {
  for (const Layer& layer : layers_) layer.end();
}

}  // namespace spillway::formats::laz
