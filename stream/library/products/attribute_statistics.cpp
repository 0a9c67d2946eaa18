#include "stream/library/products/attribute_statistics.h"

#include <algorithm>
#include <limits>

#include "formats/bytes/bytes.h"
#include "formats/bytes/number_type.h"

namespace spillway::stream {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// Widens a range by numbers that are `stride` bytes apart. NaN is no value.
template <typename Number>
void widen(const std::byte* numbers, std::size_t stride, std::size_t count,
           std::array<double, 2>& range) {
  for (std::size_t i = 0; i < count; ++i) {
    const auto value = static_cast<double>(load<Number>(numbers + i * stride));
    if (value < range[0]) range[0] = value;
    if (value > range[1]) range[1] = value;
  }
}

}  // namespace

AttributeStatistics::AttributeStatistics(const AttributeLayout& layout)
    : layout_(layout),
      ranges_(layout.fields().size(), {kInfinity, -kInfinity}),
      classes_(counts_of("classification")),
      returns_(counts_of("return_number")) {
  for (const char* const name :
       {"synthetic", "key_point", "withheld", "overlap", "edge_of_flight_line"}) {
    flags_.push_back(counts_of(name));
    if (flags_.back().field == nullptr) flags_.pop_back();
  }
}

AttributeStatistics::Counts AttributeStatistics::counts_of(const char* name) const {
  const AttributeField* const field = layout_.find(name);
  if (field == nullptr || field->attribute.type != NumberType::kUint8) return {};
  return {field, std::vector<std::uint64_t>(256)};
}

void AttributeStatistics::count(std::span<const std::byte> records, Counts& counts) const {
  if (counts.field == nullptr) return;
  for (std::size_t at = counts.field->at; at < records.size(); at += layout_.record_size()) {
    ++counts.counts[static_cast<std::size_t>(records[at])];
  }
}

void AttributeStatistics::add(std::span<const std::byte> records) {
  const std::size_t stride = layout_.record_size();
  if (stride == 0 || records.empty()) return;
  const std::size_t count_of_records = records.size() / stride;
  std::size_t f = 0;
  for (const AttributeField& field : layout_.fields()) {
    with_number_type(field.attribute.type, [&](auto number) {
      for (std::uint64_t e = 0; e < field.attribute.elements; ++e) {
        widen<decltype(number)>(&records[field.at + e * sizeof(number)], stride, count_of_records,
                                ranges_[f]);
      }
    });
    ++f;
  }
  count(records, classes_);
  count(records, returns_);
  for (Counts& flag : flags_) count(records, flag);
}

std::vector<std::pair<std::string, std::uint64_t>> AttributeStatistics::flags() const {
  std::vector<std::pair<std::string, std::uint64_t>> flags;
  for (const Counts& flag : flags_) flags.emplace_back(flag.field->attribute.name, flag.counts[1]);
  return flags;
}

std::vector<std::array<double, 2>> AttributeStatistics::ranges() const {
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  std::vector<std::array<double, 2>> ranges;
  std::size_t f = 0;
  for (const AttributeField& field : layout_.fields()) {
    auto [least, greatest] = ranges_[f++];
    if (!(least <= greatest)) {
      ranges.push_back({kNone, kNone});
      continue;
    }
    for (double* const value : {&least, &greatest}) {
      *value = *value * field.attribute.scale + field.attribute.offset + 0.0;  // -0 becomes 0
    }
    if (greatest < least) std::swap(least, greatest);  // scales may be negative
    ranges.push_back({least, greatest});
  }
  return ranges;
}

}  // namespace spillway::stream
