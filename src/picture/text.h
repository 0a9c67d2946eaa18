#pragma once
// Words in pictures, in characters of 5 x 7 dots.

#include <cstdint>
#include <string_view>

#include "src/picture/picture.h"

namespace spillway::picture {

/// Rows of dots that a line of text has.
inline constexpr std::uint32_t kTextRows = 7;

/// Columns that a text takes whose dots are `scale` pixels wide.
std::uint32_t text_width(std::string_view text, std::uint32_t scale);

/// Fills a box, as far as it is in the picture.
void fill_box(Picture& picture, std::uint32_t column, std::uint32_t row, std::uint32_t columns,
              std::uint32_t rows, const Colour& colour);

/// Draws small letters, digits, points, plus and minus from a pixel on to the right; what else
/// there is in the text becomes blanks.
void draw_text(Picture& picture, std::uint32_t column, std::uint32_t row, std::string_view text,
               std::uint32_t scale, const Colour& colour);

}  // namespace spillway::picture
