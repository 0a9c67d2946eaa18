#pragma once
// The lines that the text formats of meshes are made of.

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

#include "formats/bytes/buffered_output.h"
#include "formats/points/attributes/attribute_layout.h"
#include "src/geometry/framed_point.h"

namespace spillway::formats {

/// Appends `before` and x, y, z with the fewest digits that give the same doubles again, separated
/// by blanks.
void append_coordinates(BufferedOutput& output, std::string_view before, const WorldPoint& point);

/// Appends `before` and a number.
void append_number(BufferedOutput& output, std::string_view before, std::uint64_t number);

/// Appends the numbers of a record, a blank before each, with the fewest digits that give the same
/// again.
void append_numbers(BufferedOutput& output, const AttributeLayout& layout,
                    std::span<const std::byte> record);

/// Appends a line: `keyword` and the simplex's corners, counted from `first`.
void append_simplex(BufferedOutput& output, std::string_view keyword,
                    std::span<const std::uint64_t> corners, std::uint64_t first);

void append_line_end(BufferedOutput& output);

}  // namespace spillway::formats
