#pragma once
// From the bytes of one LAZ chunk to points: docs/formats-laz.md.

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "formats/point_reader.h"

namespace spillway::detail {

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

/// The bytes of chunks, piece by piece.
class LazBytes {
 public:
  virtual ~LazBytes() = default;
  /// The bytes behind those given out so far, valid until the next call; empty at the end.
  virtual std::span<const std::byte> more() = 0;
};

/// Decodes chunk after chunk, with memory that is used again. Throws Error, with a message that
/// names neither file nor chunk, for what cannot be the work of an encoder.
class LazChunkDecoder {
 public:
  /// `attributes`: whether classification, returns and flags are wanted besides coordinates; layers
  /// that nobody wants are skipped.
  LazChunkDecoder(const LazChunkFormat& format, bool attributes);
  ~LazChunkDecoder();
  LazChunkDecoder(LazChunkDecoder&&) noexcept;
  LazChunkDecoder& operator=(LazChunkDecoder&&) noexcept;

  /// Begins a chunk of `count` points (one at least). `bytes` must outlive the chunk. A layered
  /// chunk that says another count is an error.
  void begin(LazBytes& bytes, std::uint64_t count);

  /// The next points of the chunk, as integers; `attributes` has as many entries, or is empty if
  /// the decoder was made without.
  void decode(std::span<Point<3>> points, std::span<PointAttributes> attributes);

  /// After the chunk's last point: checks that the stream ended as encoders end it, and returns how
  /// many bytes of the last piece of `bytes` lie behind the chunk.
  std::size_t end();

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace spillway::detail
