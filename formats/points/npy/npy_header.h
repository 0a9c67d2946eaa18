#pragma once
// The header of NumPy's npy files, as docs/formats-points.md ("npy") describes it. Source: NumPy
// Enhancement Proposal 1, "A Simple File Format for NumPy Arrays".

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "formats/bytes/input_bytes.h"

namespace spillway::formats {

inline constexpr std::string_view kNpyMagic = "\x93NUMPY";

/// A field of the elements of a structured array.
struct NpyField {
  std::string name;
  std::string type;            ///< of an element, e.g. "<f8"; "structure" for one within another
  std::uint64_t elements = 1;  ///< of a sub-array; 1 if it is none
  std::uint64_t size = 0;      ///< bytes of all elements
  bool is_size_known = true;   ///< whether the type tells it
};

/// What precedes the elements of an array.
struct NpyHeader {
  std::string version = "1.0";     ///< of the format
  std::string type;                ///< of the elements, e.g. "<f8"; "structure" if they have fields
  std::vector<NpyField> fields{};  ///< of the elements, if they have some
  bool fortran_order = false;      ///< columns one after another, instead of rows
  std::vector<std::uint64_t> shape;  ///< length of each dimension
};

/// Reads a header of version 1.0, 2.0 or 3.0, up to the first element. Throws Failure that says what
/// is wrong and at which byte.
NpyHeader read_npy_header(InputBytes& source);

/// A header of version 1.0, or of 3.0 if names are not ASCII, padded as NumPy does, so that
/// elements begin at a multiple of 64 bytes. Its length does not depend on how long the array is.
/// Throws Failure that names the file `name` if the names of fields are too long.
std::string npy_header_bytes(const NpyHeader& header, const std::string& name);

}  // namespace spillway::formats
