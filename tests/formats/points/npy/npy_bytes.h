#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <string>
#include <vector>

#include "tests/formats/point_test_helpers.h"

namespace spillway::test {

/// An npy file with this dictionary and these values.
template <typename T>
std::string npy(const std::string& dictionary, const std::vector<T>& values, int version = 1) {
  std::string file = "\x93NUMPY";
  file += static_cast<char>(version);
  file += '\0';
  if (version == 1) {
    file += bytes_of(static_cast<std::uint16_t>(dictionary.size()));
  } else {
    file += bytes_of(static_cast<std::uint32_t>(dictionary.size()));
  }
  file += dictionary;
  for (const T& value : values) file += bytes_of(value);
  return file;
}

inline std::string dictionary(const std::string& type, const std::string& shape) {
  return fmt::format("{{'descr': '{}', 'fortran_order': False, 'shape': {}, }}   \n", type, shape);
}

/// The value with its bytes the other way round.
template <typename T>
T of_other_order(T value) {
  std::string bytes = bytes_of(value);
  std::ranges::reverse(bytes);
  std::memcpy(&value, bytes.data(), sizeof(T));
  return value;
}

}  // namespace spillway::test
