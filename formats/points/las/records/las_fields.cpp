#include "formats/points/las/records/las_fields.h"

#include <array>
#include <cstddef>
#include <initializer_list>
#include <utility>

#include "formats/points/las/las_header.h"
#include "formats/points/las/records/las_flags.h"

namespace spillway::formats {
namespace {

using enum NumberType;

/// Numbers in the bits of one byte.
struct Bits {
  const char* name;
  std::size_t at;
  unsigned bit;
  unsigned bits;
};

class FieldList {
 public:
  void add(const char* name, NumberType type, const char* unit = "", double scale = 1) {
    const Attribute attribute{.name = name, .type = type, .scale = scale, .unit = unit};
    fields_.push_back({.attribute = attribute, .at = at_});
    at_ += size_of(type);
  }
  void add_bits(std::initializer_list<Bits> all, std::size_t bytes) {
    for (const Bits& bits : all) {
      fields_.push_back({.attribute = {.name = bits.name, .type = kUint8},
                         .at = bits.at,
                         .packed = true,
                         .bit = bits.bit,
                         .bits = bits.bits});
    }
    at_ += bytes;
  }
  std::vector<AttributeField> take() { return std::move(fields_); }

 private:
  std::vector<AttributeField> fields_;
  std::size_t at_ = 12;  // after x, y and z
};

void add_first_fields(FieldList& fields) {
  fields.add("intensity", kUint16);
  fields.add_bits({{"return_number", 14, 0, 3},
                   {"number_of_returns", 14, 3, 3},
                   {"scan_direction", 14, 6, 1},
                   {"edge_of_flight_line", 14, 7, 1},
                   {"classification", 15, 0, 5},
                   {"synthetic", 15, 5, 1},
                   {"key_point", 15, 6, 1},
                   {"withheld", 15, 7, 1},
                   {"overlap", 15, 0, 0},
                   {"scanner_channel", 15, 0, 0}},
                  2);
  fields.add("scan_angle", kInt8, "degree");
  fields.add("user_data", kUint8);
  fields.add("point_source_id", kUint16);
}

void add_extended_fields(FieldList& fields) {
  fields.add("intensity", kUint16);
  fields.add_bits({{"return_number", 14, 0, 4},
                   {"number_of_returns", 14, 4, 4},
                   {"synthetic", 15, 0, 1},
                   {"key_point", 15, 1, 1},
                   {"withheld", 15, 2, 1},
                   {"overlap", 15, 3, 1},
                   {"scanner_channel", 15, 4, 2},
                   {"scan_direction", 15, 6, 1},
                   {"edge_of_flight_line", 15, 7, 1}},
                  2);
  fields.add("classification", kUint8);
  fields.add("user_data", kUint8);
  fields.add("scan_angle", kInt16, "degree", 0.006);
  fields.add("point_source_id", kUint16);
}

void add_colour(FieldList& fields) {
  for (const char* const name : {"red", "green", "blue"}) fields.add(name, kUint16);
}

void add_wave_packet(FieldList& fields) {
  fields.add("wave_packet_descriptor", kUint8);
  fields.add("wave_packet_offset", kUint64, "byte");
  fields.add("wave_packet_size", kUint32, "byte");
  fields.add("wave_packet_location", kFloat32, "picosecond");
  for (const char* const name : {"wave_packet_dx", "wave_packet_dy", "wave_packet_dz"}) {
    fields.add(name, kFloat32);
  }
}

constexpr bool is_one_of(int format, std::initializer_list<int> formats) {
  for (const int one : formats) {
    if (format == one) return true;
  }
  return false;
}

std::vector<AttributeField> make_fields(int format) {
  FieldList fields;
  if (format < 6) {
    add_first_fields(fields);
  } else {
    add_extended_fields(fields);
  }
  if (!is_one_of(format, {0, 2})) fields.add("gps_time", kFloat64, "second");
  if (is_one_of(format, {2, 3, 5, 7, 8, 10})) add_colour(fields);
  if (is_one_of(format, {8, 10})) fields.add("nir", kUint16);
  if (is_one_of(format, {4, 5, 9, 10})) add_wave_packet(fields);
  return fields.take();
}

}  // namespace

std::vector<AttributeField> las_flag_fields() {
  const auto field = [](const char* name, std::size_t at) {
    return AttributeField{.attribute = {.name = name, .type = kUint8}, .at = at};
  };
  std::vector<AttributeField> fields = {
      field("classification", offsetof(LasFlags, classification)),
      field("return_number", offsetof(LasFlags, return_number)),
      field("number_of_returns", offsetof(LasFlags, return_count))};
  const std::size_t flags = offsetof(LasFlags, flags);
  unsigned bit = 0;
  for (const char* const name : {"synthetic", "key_point", "withheld", "overlap"}) {
    fields.push_back({.attribute = {.name = name, .type = kUint8},
                      .at = flags,
                      .packed = true,
                      .bit = bit++,
                      .bits = 1});
  }
  return fields;
}

std::vector<AttributeField> las_fields(int point_format) { return make_fields(point_format); }

AttributeLayout las_layout(int point_format, std::span<const AttributeField> extra) {
  const auto layout_of = [extra](int format) {
    std::vector<Attribute> attributes;
    for (const AttributeField& field : make_fields(format)) {
      if (!field.packed || field.bits > 0) attributes.push_back(field.attribute);
    }
    for (const AttributeField& field : extra) attributes.push_back(field.attribute);
    return AttributeLayout(std::move(attributes));
  };
  if (!extra.empty()) return layout_of(point_format);
  static const auto plain = [&] {
    std::array<AttributeLayout, kLasRecordLengths.size()> all;
    for (std::size_t format = 0; format < all.size(); ++format) {
      all[format] = layout_of(static_cast<int>(format));
    }
    return all;
  }();
  return plain.at(point_format);
}

}  // namespace spillway::formats
