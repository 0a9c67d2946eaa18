#pragma once
// What a LAS record has besides coordinates. Source: ASPRS, "LAS Specification 1.4 - R15" (2019),
// tables 7 to 23 (point formats) and 24 to 26 (extra bytes). docs/attributes.md lists the names.

#include <spillway/attribute.h>

#include <cstddef>
#include <span>
#include <string_view>
#include <vector>

#include "formats/points/attributes/attribute_layout.h"

namespace spillway::formats {

/// The fields of a point format, 0 to 10, in the order of the record, without extra bytes.
std::vector<AttributeField> las_fields(int point_format);

/// The fields of extra bytes, by the content of their record ("LASF_Spec", 4): `bytes` of them
/// follow from byte `at` of a point on. What the record does not tell of is one field of bytes.
std::vector<AttributeField> las_extra_fields(std::span<const std::byte> descriptors, std::size_t at,
                                             std::size_t bytes);

/// The fields that extra bytes from byte `at` on have for these attributes, one after the other.
/// Throws Failure, which names no file, for an attribute that LAS cannot hold.
std::vector<AttributeField> las_extra_fields_for(std::span<const Attribute> attributes,
                                                 std::size_t at);

/// The record that tells of extra fields. What `known`, the record of the input, says of a field of
/// the same name and type stays as it is.
std::vector<std::byte> las_extra_descriptors(std::span<const AttributeField> extra,
                                             std::span<const std::byte> known);

/// All of them as attributes of a source.
AttributeLayout las_layout(int point_format, std::span<const AttributeField> extra);

}  // namespace spillway::formats
