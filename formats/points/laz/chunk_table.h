#pragma once
// Where the chunks of a LAZ file lie. docs/formats-points.md ("LAZ").

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "formats/bytes/input_bytes.h"
#include "formats/points/las/las_header.h"

namespace spillway::formats {

struct LazChunk {
  std::uint64_t offset = 0;  ///< in the file
  std::uint64_t bytes = 0;
  std::uint64_t count = 0;  ///< of points
};

/// The chunks of a file, up to the header's number of points.
struct LazChunkTable {
  std::vector<LazChunk> chunks;
  std::uint64_t more = 0;  ///< chunks that the table lists after these
};

/// Size of the pointer to the chunk table, which stands before the first chunk.
inline constexpr std::size_t kChunkTablePointer = 8;
/// What it says where the last bytes of the file are the pointer.
inline constexpr std::uint64_t kChunkTableAtTheEnd = ~std::uint64_t{0};

/// Which chunks of a table are taken.
enum class LazChunksTaken {
  kCounted,  ///< as many as hold the header's number of points
  kAll,      ///< all. Where only the header could tell of how many points the last one is, and does
             ///< not, it counts as a full one
};

/// What the table lists, in a file that can be read from any byte on (`source` is left somewhere).
/// Nothing if the table was never written.
/// Throws Failure for a table that is not that of a complete file, or, of all chunks, is damaged.
std::optional<LazChunkTable> read_chunk_table(InputBytes& source, const LasHeader& las,
                                              LazChunksTaken taken = LazChunksTaken::kCounted);

/// Reads the pointer at the beginning of the points of a source that cannot go back, and returns
/// what it says of where the chunks end; nothing where the table tells that or is missing.
std::optional<std::uint64_t> read_end_of_chunks(InputBytes& source, const LasHeader& las);

/// Bytes of the shortest chunk: its first record and what every chunk has besides.
std::size_t shortest_chunk(const LasHeader& las);

}  // namespace spillway::formats
