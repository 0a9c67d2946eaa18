#pragma once
// What points of a stream carry: the list of attributes in its header, and their columns in blocks.

#include <cstddef>
#include <span>
#include <vector>

#include "formats/blocks/block_stream.h"
#include "formats/blocks/columns.h"
#include "formats/points/attributes/attribute_layout.h"

namespace spillway::formats {

/// How many numbers all attributes of a point are.
std::size_t numbers_of_point(const AttributeLayout& layout);

/// The most points of a block, so that none outgrows kSppLargestBlock.
std::size_t spp_block_points(const AttributeLayout& layout);

/// Appends the list to the content of the header.
void append_attribute_list(std::vector<std::byte>& content, const AttributeLayout& layout);

/// Takes the list off the front of the header. Throws Failure of the stream for one that cannot be.
AttributeLayout take_attribute_list(BlockStream& stream);

/// Appends the columns of these records, one for each number of a point.
void append_attribute_columns(std::vector<std::byte>& content, const AttributeLayout& layout,
                              std::span<const std::byte> records);

/// Takes the columns of `count` points, and appends their records. Returns false for numbers that
/// are not of the attribute's type.
bool read_attribute_columns(ColumnReader& columns, const AttributeLayout& layout, std::size_t count,
                            std::vector<std::byte>& records);

}  // namespace spillway::formats
