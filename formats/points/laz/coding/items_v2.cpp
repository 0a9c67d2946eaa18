#include "formats/points/laz/coding/items_v2.h"

#include <algorithm>

#include "formats/points/laz/coding/record_fields.h"
#include "formats/points/laz/coding/return_tables.h"

namespace spillway::detail::laz {

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
  ArithmeticDecoder local = stream;
  Point10& point = point_;
  const unsigned changed = local.symbol(changed_.at(0));
  if ((changed & 32U) != 0) point.returns = local.symbol(returns_.at(point.returns));
  const unsigned number = point.returns & 7U;
  const unsigned returns = point.returns >> 3U & 7U;
  const unsigned map = kReturnMap8[returns][number];
  const unsigned single = returns == 1 ? 1 : 0;
  std::uint16_t& intensity = last_intensity_[map];
  if ((changed & 16U) != 0) {
    intensity = static_cast<std::uint16_t>(intensity_.decode(local, intensity, std::min(map, 3U)));
  }
  point.intensity = intensity;
  if ((changed & 8U) != 0) {
    point.classification = local.symbol(classification_.at(point.classification));
  }
  if ((changed & 4U) != 0) point.angle += local.symbol(angle_.at(point.returns >> 6U & 1U));
  if ((changed & 2U) != 0) point.user = local.symbol(user_.at(point.user));
  if ((changed & 1U) != 0) point.source = source_.decode(local, point.source, 0);

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
  if constexpr (kKeep == Keep::kWhole) point.store_in(part);
}

template <Keep kKeep>
void Rgb12V2<kKeep>::reset(const std::byte* /*first*/) {
  used_.reset();
  differences_.reset();
}

template <Keep kKeep>
void Rgb12V2<kKeep>::decode(ArithmeticDecoder& stream, std::byte* part) {
  constexpr unsigned kColoured = 64;
  const KeptPart<kKeep> kept(part);
  ArithmeticDecoder local = stream;
  const unsigned used = local.symbol(used_.at(0));
  std::array<int, 6> steps{};  // of the bytes so far
  for (const unsigned i : {0U, 1U}) {
    if ((used >> i & 1U) == 0) continue;
    const unsigned last = kept.byte(i);
    const unsigned byte = (last + local.symbol(differences_.at(i))) & 0xFFU;
    steps[i] = static_cast<int>(byte) - static_cast<int>(last);
    kept.put_byte(i, byte);
  }
  if ((used & kColoured) != 0) {
    // Low bytes of green and blue, then the high ones.
    for (const unsigned i : {2U, 4U, 3U, 5U}) {
      if ((used >> i & 1U) == 0) continue;
      const int last = static_cast<int>(kept.byte(i));
      // Green moves as red did, and blue as the two did on average.
      const int step = i < 4 ? steps[i - 2] : (steps[i - 4] + steps[i - 2]) / 2;
      const auto predicted = static_cast<unsigned>(std::clamp(last + step, 0, 255));
      const unsigned byte = (predicted + local.symbol(differences_.at(i))) & 0xFFU;
      steps[i] = static_cast<int>(byte) - last;
      kept.put_byte(i, byte);
    }
  } else {
    const auto red = kept.template get<std::uint16_t>(0);
    kept.put(2, red);
    kept.put(4, red);
  }
  stream = local;
}

template <Keep kKeep>
void ByteV2<kKeep>::decode(ArithmeticDecoder& stream, std::byte* part) {
  const KeptPart<kKeep> kept(part);
  ArithmeticDecoder local = stream;
  for (std::size_t i = 0; i < bytes_; ++i) {
    kept.put_byte(i, kept.byte(i) + local.symbol(differences_.at(i)));
  }
  stream = local;
}

template class Point10V2<Keep::kNeeded>;
template class Point10V2<Keep::kWhole>;
template class Rgb12V2<Keep::kNeeded>;
template class Rgb12V2<Keep::kWhole>;
template class ByteV2<Keep::kNeeded>;
template class ByteV2<Keep::kWhole>;

}  // namespace spillway::detail::laz
