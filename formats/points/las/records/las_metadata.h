#pragma once
// What LAS files tell besides points, for files that are made of them.

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "formats/bytes/shared_text.h"

namespace spillway::formats {

/// A variable length record; extended: one behind the points.
struct LasVlr {
  std::uint16_t reserved = 0;
  std::string user{};
  std::uint16_t id = 0;
  std::string description{};
  SharedText content{};  ///< bytes
  bool extended = false;

  bool operator==(const LasVlr&) const = default;
  /// Whether it tells of the coordinate system.
  [[nodiscard]] bool tells_crs() const;
  /// Whether it tells of extra bytes.
  [[nodiscard]] bool tells_extra_bytes() const;
  /// Whether it describes or holds waveforms.
  [[nodiscard]] bool tells_waveforms() const;
  /// "user 2112", for messages.
  [[nodiscard]] std::string name() const;
};

/// The records and fields of a header that say something of all points.
struct LasMetadata {
  std::string version;  ///< "1.0" to "1.5"
  int point_format = 0;
  std::uint16_t file_source = 0;
  std::uint16_t encoding = 0;  ///< the global encoding
  std::array<std::byte, 16> project{};
  std::string system;
  std::uint16_t day = 0;  ///< of creation
  std::uint16_t year = 0;
  /// All records but those that tell how points are compressed, and of the octree of COPC.
  std::vector<LasVlr> records;
  std::vector<std::string> left_out;  ///< names of records that are too long to be kept

  bool operator==(const LasMetadata&) const = default;
};

/// What holds of several files together: what all tell alike, and of each record the first. What
/// others tell otherwise is named in `left_out`. The point format is -1 where they differ. Null if
/// there are no files.
std::shared_ptr<const LasMetadata> joined(std::span<const std::shared_ptr<const LasMetadata>> all);

/// Bits of the global encoding.
inline constexpr std::uint16_t kLasGpsTimeBit = 0x01;       ///< times are standard GPS times
inline constexpr std::uint16_t kLasWaveformsInBit = 0x02;   ///< waveforms lie behind the points
inline constexpr std::uint16_t kLasWaveformsOutBit = 0x04;  ///< they lie in a file of their own
inline constexpr std::uint16_t kLasSyntheticBit = 0x08;     ///< return numbers are made up

}  // namespace spillway::formats
