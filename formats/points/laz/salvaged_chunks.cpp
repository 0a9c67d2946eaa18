#include "formats/points/laz/salvaged_chunks.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "formats/bytes/bytes.h"
#include "src/error.h"

namespace spillway::formats {
namespace {

/// The chunk that begins at `offset` and tells what it has, if it is whole before `end`.
std::optional<LazChunk> layered_chunk_at(InputBytes& source, const LasHeader& las,
                                         std::uint64_t offset, std::uint64_t end) {
  const std::size_t layers = laz_layers(las.laz->format);
  std::vector<std::byte> head(shortest_chunk(las));
  if (end - std::min(offset, end) < head.size()) return std::nullopt;
  if (!source.seek(offset) || source.read(head) < head.size()) return std::nullopt;
  LazChunk chunk{.offset = offset, .bytes = head.size()};
  chunk.count = load<std::uint32_t>(&head[las.record_length]);
  const std::size_t sizes_at = las.record_length + sizeof(std::uint32_t);
  for (std::size_t i = 0; i < layers; ++i) {
    chunk.bytes += load<std::uint32_t>(&head[sizes_at + i * sizeof(std::uint32_t)]);
  }
  const std::uint64_t most = las.laz->chunk_points.value_or(~std::uint32_t{0});
  if (chunk.count == 0 || chunk.count > most || chunk.bytes > end - offset) return std::nullopt;
  return chunk;
}

/// Layered chunks from the first one on. Where it is not known where they end, the header's number
/// of points does.
std::vector<LazChunk> walk_layered_chunks(InputBytes& source, const LasHeader& las) {
  const std::optional<std::uint64_t> told = plausible_end_of_chunks(source, las);
  const std::uint64_t end = told.value_or(las.offset_behind_points.value_or(source.size().value()));
  std::vector<LazChunk> chunks;
  std::uint64_t offset = source.position();
  std::uint64_t points = 0;
  while (told || points < las.count) {
    const std::optional<LazChunk> chunk =
        layered_chunk_at(source, las, offset, std::min(end, source.size().value()));
    if (!chunk) break;
    chunks.push_back(*chunk);
    offset += chunk->bytes;
    points += chunk->count;
    if (las.laz->chunk_points && chunk->count < *las.laz->chunk_points) break;
  }
  return chunks;
}

/// Of how many points the last chunk of a table is: all but that one have the same number.
void correct_last_chunk(InputBytes& source, const LasHeader& las, SalvagedChunks& found) {
  if (!las.laz->chunk_points || found.chunks.empty()) return;
  LazChunk& last = found.chunks.back();
  if (las.laz->format.layered) {
    const auto told = layered_chunk_at(source, las, last.offset, last.offset + last.bytes);
    if (told) last.count = told->count;
    return;
  }
  const std::uint64_t before = (found.chunks.size() - 1) * std::uint64_t{*las.laz->chunk_points};
  if (las.count > before) return;
  found.notices.push_back(
      fmt::format("the last chunk, at byte {}, is not read: nothing tells of how many points it is",
                  last.offset));
  found.chunks.pop_back();
}

void compare_with_header(const LasHeader& las, SalvagedChunks& found) {
  std::uint64_t points = 0;
  for (const LazChunk& chunk : found.chunks) points += chunk.count;
  found.lost = las.count - std::min(las.count, points);
  found.more = points > las.count;
  if (found.lost > 0) {
    found.notices.push_back(fmt::format("{} of {} points are in whole chunks: {} are lost", points,
                                        las.count, found.lost));
  } else if (found.more) {
    found.notices.push_back(
        fmt::format("the header counts {} points, but there are chunks of {}: {} more points are "
                    "read",
                    las.count, points, points - las.count));
  }
}

}  // namespace

std::optional<SalvagedChunks> salvage_chunks(InputBytes& source, const LasHeader& las) {
  SalvagedChunks found;
  std::optional<LazChunkTable> table;
  try {
    table = read_chunk_table(source, las, LazChunksTaken::kAll);
  } catch (const BadInput&) {
    table.reset();  // the chunks may be there all the same
  }
  if (table) {
    found.chunks = std::move(table->chunks);
    correct_last_chunk(source, las, found);
  } else if (las.laz->format.layered) {
    found.chunks = walk_layered_chunks(source, las);
  } else {
    return std::nullopt;
  }
  compare_with_header(las, found);
  return found;
}

std::optional<std::uint64_t> plausible_end_of_chunks(InputBytes& source, const LasHeader& las) {
  source.seek(las.offset_to_points);
  std::optional<std::uint64_t> end;
  try {
    end = read_end_of_chunks(source, las);
  } catch (const BadInput&) {
    end.reset();
  }
  source.seek(las.offset_to_points + kChunkTablePointer);
  return end && *end <= source.size().value() ? end : std::nullopt;
}

}  // namespace spillway::formats
