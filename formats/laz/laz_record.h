#pragma once
// What a LAZ file says of its compression: the record of user "laszip encoded" among those before
// the points. docs/formats-points.md ("LAZ").

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "formats/laz/chunk_decoder.h"

namespace spillway::detail {

inline constexpr const char* kLazUser = "laszip encoded";
inline constexpr std::uint16_t kLazRecordId = 22204;

enum class LazCompressor { kNone, kPointwise, kPointwiseChunked, kLayeredChunked };

/// A checked LAZ record.
struct LazRecord {
  LazCompressor compressor = LazCompressor::kNone;
  /// Points of every chunk but the last; nothing if each chunk has a number of its own.
  std::optional<std::uint32_t> chunk_points;
  LazChunkFormat format;  ///< of no use if nothing is compressed
};

/// Reads the record's content, in a file of points of that format and length. Throws Error that
/// begins with the name of the file if it is none that can be decoded.
LazRecord parse_laz_record(std::span<const std::byte> content, int point_format,
                           std::size_t record_length, const std::string& file);

/// Layers of a chunk of that format.
std::size_t laz_layers(const LazChunkFormat& format);

}  // namespace spillway::detail
