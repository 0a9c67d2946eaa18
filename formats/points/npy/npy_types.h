#pragma once
// Types of elements, as npy files name them: "<f8", "|u1". Source: NumPy, "The array interface
// protocol".

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "formats/bytes/number_type.h"

namespace spillway::formats {

/// A number in a file.
struct NpyNumber {
  NumberType type = NumberType::kFloat64;
  bool swap = false;  ///< it is big-endian
};

/// The number of that type; nothing if it is none that is read. A truth value is a number, too.
std::optional<NpyNumber> npy_number(std::string_view type);

/// Bytes of an element of that type; nothing if the type does not tell.
std::optional<std::uint64_t> npy_size(std::string_view type);

/// The type of little-endian numbers.
std::string npy_type(NumberType type);

}  // namespace spillway::formats
