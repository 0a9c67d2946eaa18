// Extra bytes and the record that tells of them: 192 bytes each, of which matter here the type
// (byte 2), options (3), name (4, 32 bytes), scale (112), offset (136) and description (160, 32
// bytes).

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <limits>
#include <optional>
#include <string>

#include "formats/points/las/records/las_fields.h"
#include "src/error.h"

namespace spillway::formats {
namespace {

using enum NumberType;

constexpr std::size_t kDescriptor = 192;
/// One record of at most 64 KiB has the descriptors of all.
constexpr std::size_t kMostDescriptors = std::numeric_limits<std::uint16_t>::max() / kDescriptor;
constexpr std::size_t kType = 2;
constexpr std::size_t kOptions = 3;
constexpr std::size_t kName = 4;
constexpr std::size_t kScale = 112;
constexpr std::size_t kOffset = 136;
constexpr std::size_t kDescription = 160;
constexpr std::size_t kText = 32;
constexpr unsigned kHasScale = 8;
constexpr unsigned kHasOffset = 16;
constexpr std::size_t kMostElements = 3;
constexpr std::size_t kMostBytes = 255;

/// By the number of the type, from 1 on; those of two and three numbers follow in the same order.
constexpr std::array<NumberType, 10> kTypes = {kUint8, kInt8,   kUint16, kInt16,   kUint32,
                                               kInt32, kUint64, kInt64,  kFloat32, kFloat64};

std::string text_at(const std::byte* bytes) {
  const std::string_view text = as_text({bytes, kText});
  return std::string(text.substr(0, text.find('\0')));
}

/// The attribute that a descriptor tells; nothing for a type that is not known.
std::optional<Attribute> attribute_of(const std::byte* descriptor) {
  const unsigned type = std::to_integer<unsigned>(descriptor[kType]);
  const unsigned options = std::to_integer<unsigned>(descriptor[kOptions]);
  Attribute attribute{.name = text_at(descriptor + kName),
                      .description = text_at(descriptor + kDescription)};
  if (type == 0) {
    attribute.type = kUint8;
    attribute.elements = options;
    return options == 0 ? std::nullopt : std::optional(attribute);
  }
  if (type > kMostElements * kTypes.size()) return std::nullopt;
  attribute.type = kTypes[(type - 1) % kTypes.size()];
  attribute.elements = 1 + (type - 1) / kTypes.size();
  const auto same_of_all = [&](std::size_t at) {
    for (std::size_t i = 1; i < attribute.elements; ++i) {
      if (load<double>(descriptor + at) != load<double>(descriptor + at + i * sizeof(double))) {
        return false;
      }
    }
    return true;
  };
  // Numbers of different scales stay as they are.
  if (!same_of_all(kScale) || !same_of_all(kOffset)) return attribute;
  const auto scale = load<double>(descriptor + kScale);
  if ((options & kHasScale) != 0 && scale != 0) attribute.scale = scale;
  if ((options & kHasOffset) != 0) attribute.offset = load<double>(descriptor + kOffset);
  return attribute;
}

unsigned type_number(const Attribute& attribute) {
  if (attribute.type == kUint8 && attribute.elements > 1) return 0;
  const auto type = std::ranges::find(kTypes, attribute.type) - kTypes.begin();
  return static_cast<unsigned>(1 + type + (attribute.elements - 1) * kTypes.size());
}

void put_text(std::byte* at, std::string_view text) {
  std::memcpy(at, text.data(), std::min(text.size(), kText));
}

void describe(const Attribute& attribute, std::byte* descriptor) {
  const unsigned type = type_number(attribute);
  unsigned options = static_cast<unsigned>(attribute.elements);
  if (type > 0) {
    options = (attribute.scale != 1 ? kHasScale : 0) | (attribute.offset != 0 ? kHasOffset : 0);
  }
  store(descriptor + kType, static_cast<std::uint8_t>(type));
  store(descriptor + kOptions, static_cast<std::uint8_t>(options));
  put_text(descriptor + kName, attribute.name);
  put_text(descriptor + kDescription, attribute.description);
  if (type == 0) return;
  for (std::size_t i = 0; i < attribute.elements; ++i) {
    if ((options & kHasScale) != 0) {
      store(descriptor + kScale + i * sizeof(double), attribute.scale);
    }
    if ((options & kHasOffset) != 0) {
      store(descriptor + kOffset + i * sizeof(double), attribute.offset);
    }
  }
}

/// A name that no field has yet: "name", "name_2", ...
std::string unique_name(std::span<const AttributeField> fields, const std::string& name,
                        std::span<const AttributeField> more) {
  const auto is_taken = [&](const std::string& wanted) {
    const auto has = [&](const AttributeField& field) { return field.attribute.name == wanted; };
    return std::ranges::any_of(fields, has) || std::ranges::any_of(more, has);
  };
  std::string unique = name;
  for (int n = 2; is_taken(unique); ++n) unique = fmt::format("{}_{}", name, n);
  return unique;
}

}  // namespace

std::vector<AttributeField> las_extra_fields(std::span<const std::byte> descriptors, std::size_t at,
                                             std::size_t bytes) {
  std::vector<AttributeField> fields;
  const std::vector<AttributeField> others = las_fields(10);
  const std::size_t end = at + bytes;
  const auto add = [&](Attribute attribute) {
    attribute.name = unique_name(fields, attribute.name, others);
    const std::size_t size = size_of(attribute);
    fields.push_back({.attribute = std::move(attribute), .at = at});
    at += size;
  };
  for (; descriptors.size() >= kDescriptor; descriptors = descriptors.subspan(kDescriptor)) {
    std::optional<Attribute> attribute = attribute_of(descriptors.data());
    if (!attribute || size_of(*attribute) > end - at) break;
    if (attribute->name.empty()) attribute->name = "extra_bytes";
    add(std::move(*attribute));
  }
  if (at < end) add({.name = "extra_bytes", .type = kUint8, .elements = end - at});
  return fields;
}

std::vector<AttributeField> las_extra_fields_for(std::span<const Attribute> attributes,
                                                 std::size_t at) {
  if (attributes.size() > kMostDescriptors) {
    throw Failure(
        fmt::format("points have {} attributes of which LAS has no fields of its own, and "
                    "it describes {} at most; write spp",
                    attributes.size(), kMostDescriptors),
        ErrorCode::kInvalidArgument, {.remedy = Remedy::kAttributes});
  }
  std::vector<AttributeField> fields;
  for (const Attribute& attribute : attributes) {
    const bool bytes = attribute.type == kUint8 && attribute.elements <= kMostBytes;
    if (attribute.elements > kMostElements && !bytes) {
      throw Failure(
          fmt::format("LAS holds at most {} numbers of an attribute, and \"{}\" has {} of "
                      "a point; write spp",
                      kMostElements, attribute.name, attribute.elements),
          ErrorCode::kInvalidArgument, {.remedy = Remedy::kAttributes});
    }
    if (attribute.name.size() > kText) {
      throw Failure(fmt::format("names of attributes in LAS have at most {} bytes, and \"{}\" has "
                                "{}; write spp",
                                kText, attribute.name, attribute.name.size()),
                    ErrorCode::kInvalidArgument, {.remedy = Remedy::kAttributes});
    }
    fields.push_back({.attribute = attribute, .at = at});
    at += size_of(attribute);
  }
  return fields;
}

std::vector<std::byte> las_extra_descriptors(std::span<const AttributeField> extra,
                                             std::span<const std::byte> known) {
  std::vector<std::byte> all(extra.size() * kDescriptor);
  std::byte* descriptor = all.data();
  for (const AttributeField& field : extra) {
    describe(field.attribute, descriptor);
    for (std::size_t at = 0; at + kDescriptor <= known.size(); at += kDescriptor) {
      const std::byte* const one = known.data() + at;
      if (text_at(one + kName) != field.attribute.name || one[kType] != descriptor[kType]) continue;
      std::memcpy(descriptor, one, kDescriptor);
      break;
    }
    descriptor += kDescriptor;
  }
  return all;
}

}  // namespace spillway::formats
