#pragma once
// Attributes of the engine, which are a record for each point, from and to those of a program,
// which are a column for each attribute.

#include <spillway/attribute_columns.h>

#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "formats/points/attributes/attribute_layout.h"
#include "src/error.h"

namespace spillway::stream {

/// The attributes that a program tells of. Throws Failure(kInvalidArgument) for those that cannot be.
AttributeLayout checked_attributes(const std::vector<Attribute>& attributes);

/// The numbers of records that have this layout.
AttributeColumns columns_of(const AttributeLayout& layout, std::span<const std::byte> records);

/// Throws Failure(kInvalidArgument) unless `columns` of a block with so many points (or what `points`
/// calls them: "vertices") have the attributes that its header has told.
void check_columns(const AttributeColumns& columns, const AttributeLayout& told, std::size_t size,
                   const char* points);

/// The numbers of `count` points from the first one on, as records of attributes that `columns`
/// have.
std::vector<std::byte> records_of(const AttributeColumns& columns, const AttributeLayout& layout,
                                  std::size_t first, std::size_t count);

/// What programs choose by names, among them "all".
AttributeChoice attribute_choice(const std::vector<std::string>& names);
/// The same the other way round.
std::vector<std::string> names_of(const AttributeChoice& choice);

/// What is thrown for a name that none of the attributes has.
InvalidArgument unknown_attribute(std::string_view name, std::span<const Attribute> attributes);

/// Throws it for a chosen name that no point has, if `offered` is what they have.
void refuse_unknown_names(const std::vector<std::string>& names, const AttributeLayout& offered);

}  // namespace spillway::stream
