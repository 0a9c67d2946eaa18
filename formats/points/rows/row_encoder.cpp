#include "formats/points/rows/row_encoder.h"

#include <cstring>
#include <stdexcept>

namespace spillway::formats {

AttributeLayout without_scales(const AttributeLayout& layout) {
  std::vector<Attribute> attributes = layout.attributes();
  for (Attribute& attribute : attributes) {
    if (attribute.scale == 1 && attribute.offset == 0) continue;
    attribute.type = NumberType::kFloat64;
    attribute.scale = 1;
    attribute.offset = 0;
  }
  return AttributeLayout(std::move(attributes));
}

RowEncoder::RowEncoder(const std::optional<IntegerLattice>& lattice, int coordinates,
                       const AttributeLayout& from, const AttributeLayout& to)
    : lattice_(lattice),
      coordinates_(coordinates),
      record_size_(from.record_size()),
      row_size_(coordinates * sizeof(double) + to.record_size()),
      conversion_(from.fields(), to.fields()) {}

std::span<const std::byte> RowEncoder::encode(std::span<const LatticePoint> points,
                                              std::span<const std::byte> records) {
  const std::size_t before = coordinates_ * sizeof(double);
  rows_.resize(points.size() * row_size_);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const WorldPoint world = in_world(lattice_, points[i]);
    std::memcpy(&rows_[i * row_size_], world.data(), before);
  }
  if (record_size_ > 0 && !points.empty() &&
      conversion_.convert(records.data(), record_size_, rows_.data() + before, row_size_,
                          points.size())) {
    throw std::logic_error("the rows do not hold the numbers of the points");
  }
  return rows_;
}

}  // namespace spillway::formats
