#include "formats/points/laz/chunk_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string>
#include <utility>

#include "formats/bytes/bytes.h"
#include "formats/points/laz/coding/arithmetic_decoder.h"
#include "formats/points/laz/coding/integer_decoder.h"
#include "formats/points/laz/file_bytes.h"
#include "src/error.h"

namespace spillway::formats {
namespace {

/// Where the table lies, and where the file ends.
struct TableRange {
  std::uint64_t offset;
  std::uint64_t end;  ///< of all bytes that may be the table's
};

[[noreturn]] void fail(const InputBytes& source, std::uint64_t byte, const std::string& what) {
  throw BadInput(source.name(), what, at_byte(byte), Remedy::kSalvage);
}

[[noreturn]] void fail_before_chunks(const InputBytes& source, std::uint64_t size) {
  fail(source, size,
       fmt::format("the file ends at byte {}, before the compressed points; get a complete "
                   "copy",
                   size));
}

std::uint64_t load_at(InputBytes& source, std::uint64_t position) {
  std::array<std::byte, sizeof(std::uint64_t)> bytes;
  if (!source.seek(position) || source.read(bytes) < bytes.size()) {
    fail(source, position,
         fmt::format("the file ends before byte {}; get a complete copy", position + bytes.size()));
  }
  return load<std::uint64_t>(bytes.data());
}

/// Nothing if the writer did not come to writing it.
std::optional<TableRange> find_table(InputBytes& source, const LasHeader& las) {
  const std::uint64_t size = source.size().value();
  const std::uint64_t first_chunk = las.offset_to_points + kChunkTablePointer;
  if (first_chunk > size) fail_before_chunks(source, size);
  TableRange range{load_at(source, las.offset_to_points), size};
  if (range.offset == las.offset_to_points) return std::nullopt;
  if (range.offset == kChunkTableAtTheEnd) {
    range.end -= kChunkTablePointer;
    range.offset = load_at(source, range.end);
  }
  if (range.offset < first_chunk || range.offset > range.end ||
      range.end - range.offset < 2 * sizeof(std::uint32_t)) {
    fail(source, size,
         fmt::format("the table of the compressed chunks should be at byte {}, but the file "
                     "ends at byte {}; get a complete copy",
                     range.offset, size));
  }
  return range;
}

/// Decodes the table's entries one by one.
class EntryDecoder {
 public:
  EntryDecoder(FileBytes& bytes, bool counts) : counts_(counts), stream_({}, &bytes) {}

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

std::optional<std::uint64_t> read_end_of_chunks(InputBytes& source, const LasHeader& las) {
  std::array<std::byte, kChunkTablePointer> bytes;
  if (source.read(bytes) < bytes.size()) {
    fail_before_chunks(source, source.position());
  }
  const auto end = load<std::uint64_t>(bytes.data());
  if (end == kChunkTableAtTheEnd || end == las.offset_to_points) return std::nullopt;
  if (end < source.position()) {
    fail(source, las.offset_to_points,
         fmt::format("the chunk table should be at byte {}, before the compressed chunks "
                     "at byte {}; the file is corrupt",
                     end, source.position()));
  }
  return end;
}

std::size_t shortest_chunk(const LasHeader& las) {
  const std::size_t layers = laz_layers(las.laz->format);
  return las.record_length + sizeof(std::uint32_t) * (las.laz->format.layered ? 1 + layers : 1);
}

std::optional<LazChunkTable> read_chunk_table(InputBytes& source, const LasHeader& las,
                                              LazChunksTaken taken) {
  const bool all = taken == LazChunksTaken::kAll;
  const std::optional<TableRange> range = find_table(source, las);
  if (!range) return std::nullopt;
  const std::uint64_t head = load_at(source, range->offset);
  const auto version = static_cast<std::uint32_t>(head);
  const std::uint64_t chunks = head >> 32U;
  const std::uint64_t first_chunk = las.offset_to_points + kChunkTablePointer;
  const std::size_t least = shortest_chunk(las);
  const std::optional<std::uint32_t> chunk_points = las.laz->chunk_points;
  if (version != 0 || chunks > (range->offset - first_chunk) / least ||
      (!all && chunk_points && chunks < las.count / *chunk_points)) {
    fail(source, range->offset,
         fmt::format("the chunk table at byte {} has version {} and {} chunks, which {} "
                     "points in {} bytes cannot have; the file is corrupt",
                     range->offset, version, chunks, las.count, range->offset - first_chunk));
  }

  FileBytes bytes(source);
  bytes.limit(range->end - source.position());
  std::vector<LazChunk> table;
  LazChunk chunk;
  chunk.offset = first_chunk;
  std::uint64_t points = 0;
  try {
    EntryDecoder entries(bytes, !chunk_points);
    while ((all || points < las.count) && table.size() < chunks) {
      const LazChunk entry = entries.next();
      chunk.bytes = entry.bytes;
      chunk.count = entry.count;
      if (chunk_points) {
        const bool is_cut = points < las.count && (!all || table.size() + 1 == chunks);
        chunk.count = is_cut ? std::min<std::uint64_t>(*chunk_points, las.count - points)
                             : std::uint64_t{*chunk_points};
      }
      if (chunk.bytes < least || chunk.bytes > range->offset - chunk.offset || chunk.count == 0 ||
          (!all && chunk.count > las.count - points)) {
        throw Failure(fmt::format("there can be no {} points in {} bytes from byte {} on",
                                  chunk.count, chunk.bytes, chunk.offset));
      }
      table.push_back(chunk);
      chunk.offset += chunk.bytes;
      points += chunk.count;
    }
  } catch (const Failure& error) {
    if (bytes.read_failed()) throw;
    fail(source, range->offset,
         fmt::format("the chunk table at byte {} is corrupt at chunk {}: {}; get a complete "
                     "copy",
                     range->offset, table.size(), error.what()));
  }
  if (!all && points < las.count) {
    fail(source, range->offset,
         fmt::format("the header says {} points, but the chunk table at byte {} lists {}; "
                     "get a complete copy",
                     las.count, range->offset, points));
  }
  const std::uint64_t more = chunks - table.size();
  return LazChunkTable{std::move(table), more};
}

}  // namespace spillway::formats
