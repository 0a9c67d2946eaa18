#include "formats/meshes/common/vertex_records.h"

#include <stdexcept>
#include <utility>

#include "formats/bytes/bytes.h"

namespace spillway::formats {

VertexRecords::VertexRecords(const MeshFileHeader& header, AttributeLayout to, Check check)
    : from_(header.attributes),
      to_(std::move(to)),
      check_(std::move(check)),
      conversion_(from_.fields(), to_.fields()) {
  const std::optional<ColourFields> from = colour_fields(from_);
  const std::optional<ColourFields> into = colour_fields(to_);
  const auto is_narrower = [&] {
    return size_of(into->front().attribute) < size_of(from->front().attribute);
  };
  if (!header.colours_are_bytes && from && into && is_narrower()) halved_ = from;
}

std::span<const std::byte> VertexRecords::convert(std::span<const std::byte> records,
                                                  std::uint64_t first) {
  if (from_.empty()) return {};
  if (check_) check_(records, first);
  if (from_ == to_) return records;
  records = with_upper_bits(records);
  const std::size_t count = records.size() / from_.record_size();
  converted_.assign(count * size(), std::byte{0});
  if (conversion_.convert(records.data(), from_.record_size(), converted_.data(), size(), count)) {
    throw std::logic_error("the records of the format do not hold the numbers of the vertices");
  }
  return converted_;
}

std::span<const std::byte> VertexRecords::with_upper_bits(std::span<const std::byte> records) {
  if (!halved_) return records;
  constexpr unsigned kBitsOfByte = 8;
  changed_.assign(records.begin(), records.end());
  for (const AttributeField& field : *halved_) {
    for (std::size_t at = field.at; at < changed_.size(); at += from_.record_size()) {
      const auto number = load<std::uint16_t>(&changed_[at]);
      store(&changed_[at], static_cast<std::uint16_t>(number >> kBitsOfByte));
    }
  }
  return changed_;
}

}  // namespace spillway::formats
