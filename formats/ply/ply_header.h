#pragma once
// The header of PLY files, as docs/formats-meshes.md ("PLY") and
// docs/formats-points.md describe it. Source: G. Turk, "The
// PLY Polygon File Format", 1994.

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "formats/bytes/input_bytes.h"
#include "formats/bytes/number_type.h"

namespace spillway::formats {

enum class PlyEncoding { kAscii, kLittleEndian, kBigEndian };

/// One value of each item of an element, or a list of values.
struct PlyProperty {
  std::string name;                        ///< in lower case
  std::string written;                     ///< the name as the file has it
  NumberType type = NumberType::kFloat64;  ///< of the value, or of the values of a list
  std::optional<NumberType> length_type;   ///< of a list's length; nothing if this is no list
};

/// A sequence of items with the same properties.
struct PlyElement {
  std::string name;
  std::uint64_t count = 0;
  std::vector<PlyProperty> properties;

  /// The place of the property of that name, or -1.
  [[nodiscard]] int find(std::string_view property) const;
};

struct PlyComment {
  std::string text;
  std::uint64_t line = 0;
};

struct PlyHeader {
  PlyEncoding encoding = PlyEncoding::kAscii;
  std::vector<PlyElement> elements;  ///< in file order, no two of the same name
  std::vector<PlyComment> comments;
  bool by_spillway = false;  ///< whether a comment is one of Spillway's notes
  std::uint64_t lines = 0;   ///< number of lines of the header

  /// The element of that name, or null.
  [[nodiscard]] const PlyElement* find(std::string_view element) const;

  /// The element of the simplices: tetrahedra if there are any, else faces. Null if there are none,
  /// unless Spillway wrote them: then this is a mesh without simplices, not a cloud of points.
  [[nodiscard]] const PlyElement* simplices() const;
};

/// The elements of a mesh.
inline constexpr std::string_view kPlyVertex = "vertex";
inline constexpr std::string_view kPlyFace = "face";
inline constexpr std::string_view kPlyTetrahedron = "tetrahedron";

/// Reads the header, up to the first value. Throws Failure that says what is wrong and in which line.
PlyHeader read_ply_header(InputBytes& source);

/// The same, and the header stays unread.
PlyHeader peek_ply_header(InputBytes& source);

/// Whether a file is PLY, by its first bytes.
bool begins_as_ply(std::string_view first_bytes);

/// The name of a type in a header: "uchar", "double"; nothing for integers of 64 bits.
std::optional<std::string_view> ply_type(NumberType type);

}  // namespace spillway::formats
