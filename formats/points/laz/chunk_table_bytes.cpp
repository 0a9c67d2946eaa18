#include "formats/points/laz/chunk_table_bytes.h"

#include <cstdint>

#include "formats/bytes/bytes.h"
#include "formats/points/laz/encoding/arithmetic_encoder.h"
#include "formats/points/laz/encoding/integer_encoder.h"

namespace spillway::formats {

std::vector<std::byte> chunk_table_bytes(std::span<const LazChunk> chunks, bool with_counts) {
  constexpr std::uint32_t kVersion = 0;
  std::vector<std::byte> bytes(2 * sizeof(std::uint32_t));
  store(bytes.data(), kVersion);
  store(&bytes[sizeof(std::uint32_t)], static_cast<std::uint32_t>(chunks.size()));
  if (chunks.empty()) return bytes;
  laz::ArithmeticEncoder stream;
  laz::IntegerEncoder<32> integers(2);
  LazChunk last;
  for (const LazChunk& chunk : chunks) {
    const auto put = [&](std::uint64_t before, std::uint64_t value, std::size_t context) {
      integers.encode(stream, static_cast<std::uint32_t>(before), static_cast<std::uint32_t>(value),
                      context);
    };
    if (with_counts) put(last.count, chunk.count, 0);
    put(last.bytes, chunk.bytes, 1);
    last = chunk;
  }
  stream.finish(bytes);
  return bytes;
}

}  // namespace spillway::formats
