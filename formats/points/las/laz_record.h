#pragma once
// What a LAZ file says of its compression: the record of user "laszip encoded" among those before
// the points. docs/formats-points.md ("LAZ").

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "src/error.h"

namespace spillway::formats {

inline constexpr const char* kLazUser = "laszip encoded";
inline constexpr std::uint16_t kLazRecordId = 22204;

/// The parts of a compressed record, by the numbers that LAZ gives them.
enum class LazItemType : std::uint16_t {
  kByte = 0,
  kPoint10 = 6,
  kGpsTime11 = 7,
  kRgb12 = 8,
  kWavePacket13 = 9,
  kPoint14 = 10,
  kRgb14 = 11,
  kRgbNir14 = 12,
  kWavePacket14 = 13,
  kByte14 = 14,
};

struct LazItem {
  LazItemType type = LazItemType::kPoint10;
  std::uint16_t size = 0;  ///< bytes in the record
  std::uint16_t version = 0;
};

/// What all chunks of a file have in common. Whoever makes one has checked that the items are those
/// of a point format and that their sizes add up.
struct LazChunkFormat {
  std::vector<LazItem> items;
  bool layered = false;  ///< compressor 3
};

enum class LazCompressor { kNone, kPointwise, kPointwiseChunked, kLayeredChunked };

/// A checked LAZ record.
struct LazRecord {
  LazCompressor compressor = LazCompressor::kNone;
  /// Points of every chunk but the last; nothing if each chunk has a number of its own.
  std::optional<std::uint32_t> chunk_points;
  LazChunkFormat format;  ///< of no use if nothing is compressed
};

/// Reads the record's content, in a file of points of that format and length. Throws BadInput
/// of `where` if it is none that can be decoded.
LazRecord parse_laz_record(std::span<const std::byte> content, int point_format,
                           std::size_t record_length, const FileSpot& where);

/// The items of records of a point format with so many bytes behind it, in the versions that are
/// written: pointwise 2 (wave packets 1), layered 3.
LazChunkFormat laz_format_to_write(int point_format, std::size_t extra_bytes);

/// The content of such a record; compressed.
std::vector<std::byte> laz_record_bytes(const LazRecord& record);

/// Layers of an item of layered chunks.
std::size_t laz_layers(const LazItem& item);

/// Layers of a chunk of that format.
std::size_t laz_layers(const LazChunkFormat& format);

}  // namespace spillway::formats
