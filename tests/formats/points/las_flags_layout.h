#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "formats/points/attributes/record_conversion.h"
#include "formats/points/las/records/las_flags.h"

namespace spillway::test {

/// A layout of what LAS says in few bytes, each flag as a number of its own.
inline AttributeLayout flags_layout() {
  std::vector<Attribute> attributes;
  for (const AttributeField& field : las_flag_fields()) attributes.push_back(field.attribute);
  return AttributeLayout(std::move(attributes));
}

/// Records of that layout.
inline std::vector<std::byte> records_of(std::span<const LasFlags> flags) {
  const AttributeLayout layout = flags_layout();
  std::vector<std::byte> records(flags.size() * layout.record_size());
  const auto fields = las_flag_fields();
  static_cast<void>(RecordConversion(fields, layout.fields())
                        .convert(std::as_bytes(flags).data(), sizeof(LasFlags), records.data(),
                                 layout.record_size(), flags.size()));
  return records;
}

/// What records of that layout say.
inline std::vector<LasFlags> flags_of(std::span<const std::byte> records) {
  const AttributeLayout layout = flags_layout();
  std::vector<LasFlags> flags(records.size() / layout.record_size());
  const auto fields = las_flag_fields();
  static_cast<void>(RecordConversion(layout.fields(), fields)
                        .convert(records.data(), layout.record_size(),
                                 std::as_writable_bytes(std::span(flags)).data(), sizeof(LasFlags),
                                 flags.size()));
  return flags;
}

}  // namespace spillway::test
