#pragma once
// What the tags of VTU files say, as docs/formats-meshes.md ("VTU") describes it.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "formats/bytes/number_type.h"
#include "formats/compression/block_decompress.h"
#include "formats/compression/expansion.h"
#include "formats/meshes/vtu/vtu_tags.h"

namespace spillway::formats {

/// How the binary arrays of a file are written: what its first tag says, and how far its blocks may
/// expand.
struct VtuCoding {
  bool swaps = false;                             ///< bytes are in the other order
  NumberType length_type = NumberType::kUint32;   ///< of the numbers that precede an array
  std::optional<BlockCompression> compression{};  ///< of the blocks of an array
  std::uint64_t max_expansion = kMostExpansion;   ///< beyond which a block expands_too_far()
};

/// Where the values of an array are.
enum class VtuPlace { kInlineText, kInlineBinary, kAppended };

/// An array, as its tag says.
struct VtuArray {
  std::string name;
  NumberType type = NumberType::kFloat64;
  VtuPlace place = VtuPlace::kInlineText;
  bool is_attribute = false;   ///< of points, for which a mesh has no name of its own
  std::size_t components = 1;  ///< of an attribute: numbers of a point
  std::uint64_t offset = 0;    ///< of appended ones: from the first byte of the appended data
};

/// What the tag VTKFile says, beside the given limit. Throws Failure for what is not read.
VtuCoding vtu_coding(const VtuTags& tags, std::uint64_t max_expansion);

/// What the tag DataArray says. Throws Failure for what is malformed.
VtuArray vtu_array(const VtuTags& tags, std::string_view name);

/// The name of a type of numbers: "UInt8", "Float64".
std::string_view vtu_type(NumberType type);

/// Whether such a name is that of a type of numbers.
bool is_vtu_type(std::string_view name);

/// Whether the tag AppendedData promises base64, and not raw bytes. Throws Failure for anything else.
bool is_appended_base64(const VtuTags& tags);

/// A number in the tag. Throws Failure if it is missing.
std::uint64_t vtu_count(const VtuTags& tags, std::string_view key);

}  // namespace spillway::formats
