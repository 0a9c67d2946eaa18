#pragma once
// The header of NumPy's npy files, as docs/formats-points.md ("npy") describes it. Source: NumPy
// Enhancement Proposal 1, "A Simple File Format for NumPy Arrays".

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "formats/bytes/input_bytes.h"

namespace spillway::detail {

inline constexpr std::string_view kNpyMagic = "\x93NUMPY";

/// What precedes the elements of an array.
struct NpyHeader {
  std::string version = "1.0";       ///< of the format
  std::string type;                  ///< of the elements, e.g. "<f8"
  bool fortran_order = false;        ///< columns one after another, instead of rows
  std::vector<std::uint64_t> shape;  ///< length of each dimension
};

/// Reads a header of version 1.0, 2.0 or 3.0, up to the first element. Throws Error that says what
/// is wrong and at which byte.
NpyHeader read_npy_header(InputBytes& source);

/// A header of version 1.0, padded as NumPy does, so that elements begin at a multiple of 64 bytes.
std::string npy_header_bytes(const NpyHeader& header);

}  // namespace spillway::detail
