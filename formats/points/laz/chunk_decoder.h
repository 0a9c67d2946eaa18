#pragma once
// From the bytes of one LAZ chunk to points: docs/formats-laz.md.

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>

#include "formats/points/common/point_reader.h"
#include "formats/points/las/laz_record.h"
#include "formats/points/las/records/las_flags.h"
#include "formats/points/laz/coding/laz_bytes.h"
#include "formats/points/laz/laz_detail.h"

namespace spillway::formats {

/// Decodes chunk after chunk, with memory that is used again. Throws Failure, with a message that
/// names neither file nor chunk, for what cannot be the work of an encoder.
class LazChunkDecoder {
 public:
  /// What `detail` does not need is skipped.
  LazChunkDecoder(const LazChunkFormat& format, LazDetail detail);
  ~LazChunkDecoder();
  LazChunkDecoder(LazChunkDecoder&&) noexcept;
  LazChunkDecoder& operator=(LazChunkDecoder&&) noexcept;

  /// Begins a chunk of `count` points (one at least). `bytes` must outlive the chunk. A layered
  /// chunk that says another count is an error.
  void begin(LazBytes& bytes, std::uint64_t count);

  /// The next points of the chunk, as integers, of a decoder made for coordinates or attributes;
  /// `attributes` has as many entries, or is empty if the decoder was made without.
  void decode(std::span<LatticePoint> points, std::span<LasFlags> attributes);

  /// The next points of the chunk as LAS records one after the other, bit for bit as an encoder got
  /// them, of a decoder made for records. The size of `records` is a multiple of a record's length.
  void decode_records(std::span<std::byte> records);

  /// After the chunk's last point: checks that the stream ended as encoders end it, and returns how
  /// many bytes of the last span of `bytes` lie after the chunk.
  std::size_t end();

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace spillway::formats
