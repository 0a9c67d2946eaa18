#include "formats/meshes/vtu/vtu_header.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "formats/bytes/fields.h"
#include "formats/bytes/line_reader.h"

namespace spillway::formats {
namespace {

template <typename Value>
struct Named {
  std::string_view name;
  Value value;
};

constexpr auto kTypes = std::to_array<Named<NumberType>>({{"Int8", NumberType::kInt8},
                                                          {"UInt8", NumberType::kUint8},
                                                          {"Int16", NumberType::kInt16},
                                                          {"UInt16", NumberType::kUint16},
                                                          {"Int32", NumberType::kInt32},
                                                          {"UInt32", NumberType::kUint32},
                                                          {"Int64", NumberType::kInt64},
                                                          {"UInt64", NumberType::kUint64},
                                                          {"Float32", NumberType::kFloat32},
                                                          {"Float64", NumberType::kFloat64}});
constexpr auto kEncodings = std::to_array<Named<bool>>({{"raw", false}, {"base64", true}});

// What VTK takes where nothing is said comes first, under the name "".
constexpr auto kByteOrders =
    std::to_array<Named<bool>>({{"", false}, {"LittleEndian", false}, {"BigEndian", true}});
constexpr auto kLengthTypes = std::to_array<Named<NumberType>>(
    {{"", NumberType::kUint32}, {"UInt32", NumberType::kUint32}, {"UInt64", NumberType::kUint64}});
constexpr auto kPlaces = std::to_array<Named<VtuPlace>>({{"", VtuPlace::kInlineText},
                                                         {"ascii", VtuPlace::kInlineText},
                                                         {"binary", VtuPlace::kInlineBinary},
                                                         {"appended", VtuPlace::kAppended}});
constexpr auto kCompressors = std::to_array<Named<std::optional<BlockCompression>>>(
    {{"", std::nullopt},
     {"vtkZLibDataCompressor", BlockCompression::kZlib},
     {"vtkLZ4DataCompressor", BlockCompression::kLz4},
     {"vtkLZMADataCompressor", BlockCompression::kXz}});

/// The value that an attribute names.
template <typename Value, std::size_t kCount>
Value value_of(const VtuTags& tags, std::string_view key,
               const std::array<Named<Value>, kCount>& known) {
  const std::string_view found = tags.tag().attribute(key);
  std::string names;
  for (const Named<Value>& each : known) {
    if (each.name == found) return each.value;
    if (!each.name.empty()) names += (names.empty() ? "" : ", ") + std::string(each.name);
  }
  tags.fail(fmt::format("{} has {}={}, but it must be one of these: {}; save the mesh so",
                        tags.tag().name, key, quoted(found), names));
}

}  // namespace

VtuCoding vtu_coding(const VtuTags& tags, std::uint64_t max_expansion) {
  const std::string_view type = tags.tag().attribute("type");
  if (type != "UnstructuredGrid") {
    tags.fail(
        fmt::format("the VTK file is of type {}, but only UnstructuredGrid is read; save the "
                    "mesh as .vtu",
                    quoted(type)));
  }
  return {value_of(tags, "byte_order", kByteOrders), value_of(tags, "header_type", kLengthTypes),
          value_of(tags, "compressor", kCompressors), max_expansion};
}

VtuArray vtu_array(const VtuTags& tags, std::string_view name) {
  VtuArray array;
  array.name = name;
  array.type = value_of(tags, "type", kTypes);
  array.place = value_of(tags, "format", kPlaces);
  if (array.place == VtuPlace::kAppended) array.offset = vtu_count(tags, "offset");
  return array;
}

std::string_view vtu_type(NumberType type) {
  return std::ranges::find(kTypes, type, &Named<NumberType>::value)->name;
}

bool is_vtu_type(std::string_view name) {
  return std::ranges::find(kTypes, name, &Named<NumberType>::name) != kTypes.end();
}

bool is_appended_base64(const VtuTags& tags) { return value_of(tags, "encoding", kEncodings); }

std::uint64_t vtu_count(const VtuTags& tags, std::string_view key) {
  const std::optional<std::uint64_t> count = parse_count(tags.tag().attribute(key));
  if (!count) tags.fail(fmt::format("{} has no number {}", tags.tag().name, key));
  return *count;
}

}  // namespace spillway::formats
