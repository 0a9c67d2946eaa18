#pragma once
// The header of PCD files, as docs/formats-points.md ("PCD") describes it. Source: "The PCD (Point
// Cloud Data) file format", Point Cloud Library, version 0.7.

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "formats/bytes/input_bytes.h"
#include "formats/bytes/number_type.h"

namespace spillway::formats {

enum class PcdEncoding : std::uint8_t { kAscii, kBinary, kCompressed };

/// Numbers that each point has.
struct PcdField {
  std::string name;
  NumberType type = NumberType::kFloat32;
  std::size_t count = 1;

  /// Whether these are bytes that mean nothing.
  [[nodiscard]] bool is_padding() const { return name == "_"; }
  [[nodiscard]] std::size_t size() const { return size_of(type) * count; }
};

struct PcdHeader {
  std::string version;
  std::vector<PcdField> fields;
  std::uint64_t points = 0;
  PcdEncoding encoding = PcdEncoding::kAscii;
  bool has_viewpoint = false;  ///< another one than the origin, looking ahead
  std::uint64_t lines = 0;     ///< of the header
};

/// Whether a file is PCD, by its first bytes.
bool begins_as_pcd(std::string_view first_bytes);

/// Reads the header; the source is then at the first byte of the points. Throws BadInput with the
/// line.
PcdHeader read_pcd_header(InputBytes& source);

}  // namespace spillway::formats
