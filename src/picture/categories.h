#pragma once
// What numbers of classes and returns stand for, and their colours.

#include <cstdint>
#include <string>

#include "src/picture/colour_pixels.h"

namespace spillway::picture {

struct Category {
  std::string name;
  ByteColour colour{};
};

/// Of classification, by the numbers of LAS 1.4 R16, table 17; beyond these by number.
Category category_of_class(std::uint8_t number);

/// Of return_number.
Category category_of_return(std::uint8_t number);

}  // namespace spillway::picture
