#include "formats/points/rows/row_decoder.h"

#include <fmt/format.h>

#include <cmath>
#include <cstdlib>
#include <stdexcept>
#include <type_traits>
#include <vector>

#include "formats/bytes/bytes.h"
#include "src/error.h"

namespace spillway::formats {
namespace {

/// Integers beyond this are not all doubles.
constexpr std::int64_t kLargestExact = std::int64_t{1} << 53;

template <typename T>
bool representable(T value) {
  if constexpr (std::is_floating_point_v<T>) {
    return std::isfinite(value);
  } else if constexpr (sizeof(T) < sizeof(double)) {
    return true;
  } else {
    return std::cmp_less_equal(value, kLargestExact) &&
           std::cmp_greater_equal(value, -kLargestExact);
  }
}

bool representable_at(const RowLayout::Coordinate& coordinate, const std::byte* row) {
  return with_number_type(coordinate.type, [&](auto number) {
    return representable(load<decltype(number)>(row + coordinate.at));
  });
}

}  // namespace

void RowDecoder::choose_coordinates() {
  const NumberType type = layout_.coordinate(0).type;
  bool alike = true;
  for (int axis = 1; axis < layout_.coordinates(); ++axis) {
    alike &= layout_.coordinate(axis).type == type;
  }
  if (!alike) {
    decode_coordinates_ = &RowDecoder::decode_any;
    return;
  }
  with_number_type(type, [&](auto number) {
    decode_coordinates_ = &RowDecoder::decode_alike<decltype(number)>;
  });
}

void RowDecoder::carry(const AttributeLayout& wanted) {
  conversion_ = RecordConversion(layout_.attributes(), wanted.fields());
  record_size_ = wanted.record_size();
}

void RowDecoder::decode(std::span<std::byte> rows, std::uint64_t first, PointBlock& block) const {
  layout_.make_native(rows);
  const std::size_t count = rows.size() / layout_.size();
  block.clear();
  block.points.resize(count);
  block.index.resize(count);
  for (std::size_t i = 0; i < count; ++i) block.index[i] = first + i;
  const bool valid = (this->*decode_coordinates_)(rows.data(), block);
  if (!valid && !skips_invalid_) fail_at_first_invalid(rows.data(), first);
  block.attributes.assign(count * record_size_, std::byte{0});
  if (record_size_ > 0 && conversion_.convert(rows.data(), layout_.size(), block.attributes.data(),
                                              record_size_, count)) {
    throw std::logic_error("the layout does not hold the numbers of one of its sources");
  }
  if (valid) return;
  block.keep([&](std::size_t i) { return is_point(rows.data() + i * layout_.size()); });
  block.invalid = count - block.size();
}

template <typename T>
bool RowDecoder::decode_alike(const std::byte* rows, PointBlock& block) const {
  const std::size_t step = layout_.size();
  const std::byte* x = rows + layout_.coordinate(0).at;
  const std::byte* y = rows + layout_.coordinate(1).at;
  bool valid = true;
  if (layout_.coordinates() == 2) {
    for (LatticePoint& point : block.points) {
      const T values[] = {load<T>(x), load<T>(y)};
      valid &= representable(values[0]);
      valid &= representable(values[1]);
      point = {static_cast<double>(values[0]), static_cast<double>(values[1]), 0};
      x += step;
      y += step;
    }
    return valid;
  }
  const std::byte* z = rows + layout_.coordinate(2).at;
  for (LatticePoint& point : block.points) {
    const T values[] = {load<T>(x), load<T>(y), load<T>(z)};
    for (const T value : values) valid &= representable(value);
    point = {static_cast<double>(values[0]), static_cast<double>(values[1]),
             static_cast<double>(values[2])};
    x += step;
    y += step;
    z += step;
  }
  return valid;
}

bool RowDecoder::decode_any(const std::byte* rows, PointBlock& block) const {
  bool valid = true;
  for (LatticePoint& point : block.points) {
    point = {};
    for (int axis = 0; axis < layout_.coordinates(); ++axis) {
      const RowLayout::Coordinate& coordinate = layout_.coordinate(axis);
      point[axis] = load_number(coordinate.type, rows + coordinate.at);
      valid &= representable_at(coordinate, rows);
    }
    rows += layout_.size();
  }
  return valid;
}

bool RowDecoder::is_point(const std::byte* row) const {
  for (int axis = 0; axis < layout_.coordinates(); ++axis) {
    if (!representable_at(layout_.coordinate(axis), row)) return false;
  }
  return true;
}

void RowDecoder::fail_at_first_invalid(const std::byte* rows, std::uint64_t first) const {
  std::uint64_t point = first;
  for (; is_point(rows); ++point) rows += layout_.size();
  int axis = 0;
  while (representable_at(layout_.coordinate(axis), rows)) ++axis;
  const RowLayout::Coordinate& bad = layout_.coordinate(axis);
  const std::string value = with_number_type(bad.type, [&](auto number) {
    return fmt::format("{}", +load<decltype(number)>(rows + bad.at));
  });
  throw BadInput(
      file_,
      fmt::format("point {} has the coordinate {}, which is {}; correct or remove the "
                  "point",
                  point, value, is_integer(bad.type) ? "beyond 2^53, not exact" : "not finite"),
      at_record(point));
}

}  // namespace spillway::formats
