#include "formats/points/laz/coding/pointwise_item.h"

#include "formats/points/laz/coding/record_fields.h"

namespace spillway::formats::laz {

Point10 Point10::of_record(const std::byte* record) {
  Point10 point;
  point.x = load<std::int32_t>(record + kX);
  point.y = load<std::int32_t>(record + kY);
  point.z = load<std::int32_t>(record + kZ);
  point.returns = load<std::uint8_t>(record + kReturns);
  point.classification = load<std::uint8_t>(record + core10::kClass);
  point.user = load<std::uint8_t>(record + core10::kUser);
  return point;
}

void Point10::store_in(std::byte* record) const {
  store(record + kX, x);
  store(record + kY, y);
  store(record + kZ, z);
  store(record + kReturns, returns);
  store(record + core10::kClass, classification);
  store(record + core10::kUser, user);
}

}  // namespace spillway::formats::laz
