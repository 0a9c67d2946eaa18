#include "formats/points/laz/coding/point14_layers.h"

#include <algorithm>

#include "formats/points/laz/coding/record_fields.h"
#include "formats/points/laz/coding/return_tables.h"
#include "src/error.h"

namespace spillway::formats::laz {
namespace {

enum LayerIndex : unsigned { kXyLayer, kZLayer, kClassLayer, kFlagsLayer };

}  // namespace

Point14 Point14::of_record(const std::byte* record) {
  const unsigned returns = byte_at(record, kReturns);
  const unsigned bits = byte_at(record, core14::kFlags);
  Point14 point;
  point.x = load<std::int32_t>(record + kX);
  point.y = load<std::int32_t>(record + kY);
  point.z = load<std::int32_t>(record + kZ);
  point.return_number = returns & 15U;
  point.return_count = returns >> 4U;
  point.channel = bits >> 4U & 3U;
  point.flags = (bits & 15U) | (bits >> 6U) << 4U;
  point.classification = load<std::uint8_t>(record + core14::kClass);
  return point;
}

void Point14::store_in(std::byte* record) const {
  store(record + kX, x);
  store(record + kY, y);
  store(record + kZ, z);
  put_byte(record, kReturns, return_number | return_count << 4U);
  put_byte(record, core14::kFlags, (flags & 15U) | channel << 4U | (flags >> 4U) << 6U);
  store(record + core14::kClass, classification);
}

void Point14Layers::Context::begin(const Point14& point) {
  changes.reset();
  channel.reset();
  return_count.reset();
  return_number.reset();
  return_step.reset();
  dx.reset();
  dy.reset();
  z.reset();
  classification.reset();
  flags.reset();
  dx_median.fill({});
  dy_median.fill({});
  last_z.fill(point.z);
  last = point;
  changed = 0;
}

std::span<const std::byte> Point14Layers::begin(const Point14& first,
                                                std::span<const std::byte> layers,
                                                std::span<const std::size_t, kLayers> sizes,
                                                std::uint64_t count) {
  if (count > 1 && sizes[kXyLayer] == 0) throw Failure("the compressed chunk has no coordinates");
  for (std::size_t i = 0; i < kLayers; ++i) layers = layers_[i].begin(layers, sizes[i]);
  contexts_.reset();
  current_ = &contexts_.use(first.channel, first);
  return layers;
}

void Point14Layers::decode() {
  ArithmeticDecoder xy = layers_[kXyLayer].stream;
  const Point14& before = current_->last;
  const unsigned change_context = (before.return_number == 1 ? 1U : 0U) |
                                  (before.return_number >= before.return_count ? 2U : 0U) |
                                  (current_->changed >> 2U & 4U);
  const unsigned changed = xy.symbol(current_->changes.at(change_context));
  if ((changed & 64U) != 0) {
    const unsigned channel = (before.channel + xy.symbol(current_->channel.at(0)) + 1) & 3U;
    current_ = &contexts_.use(channel, before);
    current_->last.channel = static_cast<std::uint8_t>(channel);
  }
  Context& context = *current_;
  Point14& point = context.last;
  const bool time_changed = (changed & 16U) != 0;
  context.changed = changed;

  unsigned returns = point.return_count;
  if ((changed & 4U) != 0) returns = xy.symbol(context.return_count.at(returns));
  unsigned number = point.return_number;
  if ((changed & 3U) == 1) number = (number + 1) & 15U;
  if ((changed & 3U) == 2) number = (number + 15) & 15U;
  if ((changed & 3U) == 3) {
    number = time_changed ? xy.symbol(context.return_number.at(number))
                          : (number + xy.symbol(context.return_step.at(0)) + 2) & 15U;
  }
  point.return_count = static_cast<std::uint8_t>(returns);
  point.return_number = static_cast<std::uint8_t>(number);

  const unsigned single = returns == 1 ? 1 : 0;
  const unsigned median = 2U * kReturnMap16[returns][number] + (time_changed ? 1U : 0U);
  const std::uint32_t dx = context.dx.decode(xy, context.dx_median[median].get(), single);
  point.x = static_cast<std::int32_t>(point.x + dx);
  context.dx_median[median].add(static_cast<std::int32_t>(dx));
  const unsigned dx_width = context.dx.width();
  const unsigned dy_context = single + (std::min(dx_width, 20U) & ~1U);
  const std::uint32_t dy = context.dy.decode(xy, context.dy_median[median].get(), dy_context);
  point.y = static_cast<std::int32_t>(point.y + dy);
  context.dy_median[median].add(static_cast<std::int32_t>(dy));
  layers_[kXyLayer].stream = xy;

  if (layers_[kZLayer].present) {
    ArithmeticDecoder stream = layers_[kZLayer].stream;
    const unsigned width = (dx_width + context.dy.width()) / 2;
    std::int32_t& last_z = context.last_z[return_level(returns, number)];
    last_z = static_cast<std::int32_t>(
        context.z.decode(stream, last_z, single + (std::min(width, 18U) & ~1U)));
    point.z = last_z;
    layers_[kZLayer].stream = stream;
  }
  if (layers_[kClassLayer].present) {
    const unsigned only = number == 1 && number >= returns ? 1 : 0;
    point.classification = layers_[kClassLayer].stream.symbol(
        context.classification.at(2U * (point.classification & 31U) + only));
  }
  if (layers_[kFlagsLayer].present) {
    point.flags = layers_[kFlagsLayer].stream.symbol(context.flags.at(point.flags));
  }
}

Point14Changes Point14Layers::changes() const {
  const unsigned changed = current_->changed;
  return {.channel = (changed & 64U) != 0,
          .time = (changed & 16U) != 0,
          .angle = (changed & 8U) != 0,
          .source = (changed & 32U) != 0};
}

void Point14Layers::end() const {
  for (const Layer& layer : layers_) layer.end();
}

}  // namespace spillway::formats::laz
