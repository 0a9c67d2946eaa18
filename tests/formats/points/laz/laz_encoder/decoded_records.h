#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

#include "formats/points/las/laz_record.h"
#include "formats/points/laz/chunk_decoder.h"

namespace spillway::test {

/// The bytes of a record.
std::size_t record_length_of(const LazChunkFormat& format);

/// The records of a chunk one after the other, decoded by calls for up to `at_a_time` of them.
/// Throws Failure also for bytes behind the chunk.
std::string decode_laz_records(LazChunkDecoder& decoder, std::size_t record_length,
                               std::span<const std::byte> chunk, std::uint64_t count,
                               std::uint64_t at_a_time = UINT64_MAX);

/// Likewise, with a decoder of its own.
std::string decode_laz_records(const LazChunkFormat& format, std::span<const std::byte> chunk,
                               std::uint64_t count);

}  // namespace spillway::test
