#include "formats/points/laz/chunk_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string>

#include "formats/bytes/bytes.h"
#include "formats/points/laz/coding/arithmetic_decoder.h"
#include "formats/points/laz/coding/integer_decoder.h"
#include "formats/points/laz/source_bytes.h"
#include "src/error.h"

namespace spillway::detail {
namespace {

/// Where the table lies, and where the file ends.
struct TablePlace {
  std::uint64_t offset;
  std::uint64_t end;  ///< of all bytes that may be the table's
};

[[noreturn]] void fail(const InputSource& source, const std::string& what) {
  throw Error(fmt::format("{}: {}", source.name(), what));
}

[[noreturn]] void fail_before_chunks(const InputSource& source, std::uint64_t size) {
  fail(source, fmt::format("the file ends at byte {}, before the compressed points; get a complete "
                           "copy",
                           size));
}

std::uint64_t load_at(InputSource& source, std::uint64_t position) {
  std::array<std::byte, sizeof(std::uint64_t)> bytes;
  if (!source.seek(position) || source.read(bytes) < bytes.size()) {
    fail(source,
         fmt::format("the file ends before byte {}; get a complete copy", position + bytes.size()));
  }
  return load<std::uint64_t>(bytes.data());
}

constexpr std::uint64_t kToldAtTheEnd = ~std::uint64_t{0};  // of the file

/// Nothing if the writer did not come to writing it.
std::optional<TablePlace> find_table(InputSource& source, const LasHeader& las) {
  const std::uint64_t size = source.size().value();
  const std::uint64_t first_chunk = las.offset_to_points + kChunkTablePointer;
  if (first_chunk > size) fail_before_chunks(source, size);
  TablePlace place{load_at(source, las.offset_to_points), size};
  if (place.offset == las.offset_to_points) return std::nullopt;
  if (place.offset == kToldAtTheEnd) {
    place.end -= kChunkTablePointer;
    place.offset = load_at(source, place.end);
  }
  if (place.offset < first_chunk || place.offset > place.end ||
      place.end - place.offset < 2 * sizeof(std::uint32_t)) {
    fail(source,
         fmt::format("the table of the compressed chunks should be at byte {}, but the file "
                     "ends at byte {}; get a complete copy",
                     place.offset, size));
  }
  return place;
}

/// Decodes the table's entries one by one.
class EntryDecoder {
 public:
  EntryDecoder(SourceBytes& bytes, bool counts) : counts_(counts), stream_({}, &bytes) {}

  /// The next chunk's size, and its number of points where that is stored.
  LazChunk next() {
    if (counts_)
      last_.count = integers_.decode(stream_, static_cast<std::uint32_t>(last_.count), 0);
    last_.bytes = integers_.decode(stream_, static_cast<std::uint32_t>(last_.bytes), 1);
    return last_;
  }

 private:
  bool counts_;
  laz::ArithmeticDecoder stream_;
  laz::IntegerDecoder<32> integers_{2};
  LazChunk last_;
};

}  // namespace

std::optional<std::uint64_t> read_end_of_chunks(InputSource& source, const LasHeader& las) {
  std::array<std::byte, kChunkTablePointer> bytes;
  if (source.read(bytes) < bytes.size()) {
    fail_before_chunks(source, source.position());
  }
  const auto end = load<std::uint64_t>(bytes.data());
  if (end == kToldAtTheEnd || end == las.offset_to_points) return std::nullopt;
  if (end < source.position()) {
    fail(source, fmt::format("the chunk table should be at byte {}, before the compressed chunks "
                             "at byte {}; the file is corrupt",
                             end, source.position()));
  }
  return end;
}

std::size_t shortest_chunk(const LasHeader& las) {
  const std::size_t layers = laz_layers(las.laz->format);
  return las.record_length + sizeof(std::uint32_t) * (las.laz->format.layered ? 1 + layers : 1);
}

std::optional<std::vector<LazChunk>> read_chunk_table(InputSource& source, const LasHeader& las) {
  const std::optional<TablePlace> place = find_table(source, las);
  if (!place) return std::nullopt;
  const std::uint64_t head = load_at(source, place->offset);
  const auto version = static_cast<std::uint32_t>(head);
  const std::uint64_t chunks = head >> 32U;
  const std::uint64_t first_chunk = las.offset_to_points + kChunkTablePointer;
  const std::size_t least = shortest_chunk(las);
  const std::optional<std::uint32_t> chunk_points = las.laz->chunk_points;
  if (version != 0 || chunks > (place->offset - first_chunk) / least ||
      (chunk_points && chunks < las.count / *chunk_points)) {
    fail(source,
         fmt::format("the chunk table at byte {} has version {} and {} chunks, which {} "
                     "points in {} bytes cannot have; the file is corrupt",
                     place->offset, version, chunks, las.count, place->offset - first_chunk));
  }

  SourceBytes bytes(source);
  bytes.limit(place->end - source.position());
  std::vector<LazChunk> table;
  LazChunk chunk;
  chunk.offset = first_chunk;
  std::uint64_t points = 0;
  try {
    EntryDecoder entries(bytes, !chunk_points);
    while (points < las.count && table.size() < chunks) {
      const LazChunk entry = entries.next();
      chunk.bytes = entry.bytes;
      chunk.count =
          chunk_points ? std::min<std::uint64_t>(*chunk_points, las.count - points) : entry.count;
      if (chunk.bytes < least || chunk.bytes > place->offset - chunk.offset || chunk.count == 0 ||
          chunk.count > las.count - points) {
        throw Error(fmt::format("{} points in {} bytes from byte {} on cannot be", chunk.count,
                                chunk.bytes, chunk.offset));
      }
      table.push_back(chunk);
      chunk.offset += chunk.bytes;
      points += chunk.count;
    }
  } catch (const Error& error) {
    if (bytes.read_failed()) throw;
    fail(source,
         fmt::format("the chunk table at byte {} is corrupt at chunk {}: {}; get a complete "
                     "copy",
                     place->offset, table.size(), error.what()));
  }
  if (points < las.count) {
    fail(source, fmt::format("the header says {} points, but the chunk table at byte {} lists {}; "
                             "get a complete copy",
                             las.count, place->offset, points));
  }
  return table;
}

}  // namespace spillway::detail
