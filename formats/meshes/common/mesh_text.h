#pragma once
// The lines that the text formats of meshes are made of.

#include <cstdint>
#include <span>
#include <string_view>

#include "formats/bytes/buffered_output.h"
#include "src/geometry/framed_point.h"

namespace spillway::detail {

/// Appends `before` and x, y, z with the fewest digits that give the same doubles again, separated
/// by blanks.
void append_coordinates(BufferedOutput& output, std::string_view before, const WorldPoint& point);

/// Appends `before` and a number.
void append_number(BufferedOutput& output, std::string_view before, std::uint64_t number);

/// Appends a line: `keyword` and the simplex's corners, counted from `first`.
void append_simplex(BufferedOutput& output, std::string_view keyword,
                    std::span<const std::uint64_t> corners, std::uint64_t first);

void append_line_end(BufferedOutput& output);

}  // namespace spillway::detail
