#include "formats/points/laz/coding/items_v2.h"

#include <algorithm>

#include "formats/points/laz/coding/record_fields.h"
#include "formats/points/laz/coding/return_tables.h"

namespace spillway::formats::laz {
namespace {

/// The six bytes of the last colour, which become those of the next one.
template <Keep kKeep>
class Colour {
 public:
  explicit Colour(std::byte* part) : kept_(part) {}

  /// Adds a difference to the prediction of a byte: green moves as red did, and blue as the two did
  /// on average.
  void move(unsigned i, unsigned difference) {
    if constexpr (kKeep == Keep::kWhole) {
      const int last = static_cast<int>(kept_.byte_at(i));
      const int step = i < 2 ? 0 : i < 4 ? steps_[i - 2] : (steps_[i - 4] + steps_[i - 2]) / 2;
      const auto predicted = static_cast<unsigned>(std::clamp(last + step, 0, 255));
      const unsigned byte = (predicted + difference) & 0xFFU;
      steps_[i] = static_cast<int>(byte) - last;
      kept_.put_byte(i, byte);
    }
  }

  void make_grey() {
    const auto red = kept_.template get<std::uint16_t>(0);
    kept_.put(2, red);
    kept_.put(4, red);
  }

 private:
  KeptPart<kKeep> kept_;
  std::array<int, 6> steps_{};
};

}  // namespace

template <Keep kKeep>
void Point10V2<kKeep>::reset(const std::byte* first) {
  point_ = Point10::of_record(first);
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
  last_intensity_.fill(0);
  last_z_.fill(0);
}

template <Keep kKeep>
void Point10V2<kKeep>::decode(ArithmeticDecoder& stream, std::byte* part) {
  constexpr bool kWhole = kKeep == Keep::kWhole;
  const KeptPart<kKeep> kept(part);
  ArithmeticDecoder local = stream;
  Point10& point = point_;
  const unsigned changed = local.symbol(changed_.at(0));
  if ((changed & 32U) != 0) point.returns = local.symbol(returns_.at(point.returns));
  const unsigned number = point.returns & 7U;
  const unsigned returns = point.returns >> 3U & 7U;
  const unsigned map = kReturnMap8[returns][number];
  const unsigned single = returns == 1 ? 1 : 0;
  if ((changed & 16U) != 0) {
    const std::uint32_t last = kWhole ? last_intensity_[map] : 0;
    const std::uint32_t intensity = intensity_.decode(local, last, std::min(map, 3U));
    if constexpr (kWhole) last_intensity_[map] = static_cast<std::uint16_t>(intensity);
  }
  kept.put_short(kIntensity, kWhole ? last_intensity_[map] : 0);
  if ((changed & 8U) != 0) {
    point.classification = local.symbol(classification_.at(point.classification));
  }
  if ((changed & 4U) != 0) {
    const unsigned step = local.symbol(angle_.at(point.returns >> 6U & 1U));
    kept.put_byte(core10::kAngle, kept.byte_at(core10::kAngle) + step);
  }
  if ((changed & 2U) != 0) point.user = local.symbol(user_.at(point.user));
  if ((changed & 1U) != 0) {
    kept.put_short(core10::kSource, source_.decode(local, kept.short_at(core10::kSource), 0));
  }

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
  if constexpr (kWhole) point.store_in(part);
}

template <Keep kKeep>
void Rgb12V2<kKeep>::reset(const std::byte* /*first*/) {
  used_.reset();
  differences_.reset();
}

template <Keep kKeep>
void Rgb12V2<kKeep>::decode(ArithmeticDecoder& stream, std::byte* part) {
  constexpr unsigned kColoured = 64;
  ArithmeticDecoder local = stream;
  const unsigned used = local.symbol(used_.at(0));
  Colour<kKeep> colour(part);
  if ((used & 1U) != 0) colour.move(0, local.symbol(differences_.at(0)));
  if ((used & 2U) != 0) colour.move(1, local.symbol(differences_.at(1)));
  if ((used & kColoured) != 0) {
    // Low bytes of green and blue, then the high ones.
    for (const unsigned i : {2U, 4U, 3U, 5U}) {
      if ((used >> i & 1U) != 0) colour.move(i, local.symbol(differences_.at(i)));
    }
  } else {
    colour.make_grey();
  }
  stream = local;
}

template <Keep kKeep>
void ByteV2<kKeep>::decode(ArithmeticDecoder& stream, std::byte* part) {
  const KeptPart<kKeep> kept(part);
  ArithmeticDecoder local = stream;
  for (std::size_t i = 0; i < bytes_; ++i) {
    kept.put_byte(i, kept.byte_at(i) + local.symbol(differences_.at(i)));
  }
  stream = local;
}

template class Point10V2<Keep::kNeeded>;
template class Point10V2<Keep::kWhole>;
template class Rgb12V2<Keep::kNeeded>;
template class Rgb12V2<Keep::kWhole>;
template class ByteV2<Keep::kNeeded>;
template class ByteV2<Keep::kWhole>;

}  // namespace spillway::formats::laz
