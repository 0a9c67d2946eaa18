#include "stream/tiles/storage/tile_block.h"

#include <fmt/format.h>

#include <algorithm>

#include "formats/blocks/block.h"
#include "formats/blocks/columns.h"
#include "src/error.h"

namespace spillway::detail {
namespace {

/// A block's kind is the number of its points, and whether they have an index.
constexpr std::uint32_t kIndexed = 1;

std::uint32_t kind_of(std::size_t points, bool indexed) {
  return static_cast<std::uint32_t>(2 * points) + (indexed ? kIndexed : 0);
}

std::size_t points_of(const BlockHead& head) { return head.kind / 2; }

}  // namespace

void append_points(std::vector<std::byte>& bytes, std::span<const LatticePoint> points,
                   std::span<const std::uint64_t> index) {
  std::vector<std::byte> content;
  std::vector<double> column(points.size());
  for (int k = 0; k < 3; ++k) {
    for (std::size_t i = 0; i < points.size(); ++i) column[i] = points[i][k];
    append_column(content, column);
  }
  if (!index.empty()) append_column(content, index);
  append_block(bytes, kind_of(points.size(), !index.empty()), content);
}

void append_all_points(std::vector<std::byte>& bytes, std::span<const LatticePoint> points,
                       std::span<const std::uint64_t> index) {
  for (std::size_t i = 0; i < points.size(); i += PointBuffer::kChunk) {
    const std::size_t count = std::min(PointBuffer::kChunk, points.size() - i);
    append_points(bytes, points.subspan(i, count), index.empty() ? index : index.subspan(i, count));
  }
}

std::vector<TileBlock> encode_points(PointBuffer& points, std::vector<std::byte>& bytes) {
  std::vector<TileBlock> blocks;
  points.drain_in_chunks(
      [&](std::span<const LatticePoint> some, std::span<const std::uint64_t> index) {
        const std::size_t begin = bytes.size();
        append_points(bytes, some, index);
        blocks.push_back({begin, bytes.size() - begin, some.size()});
      });
  return blocks;
}

std::vector<TileBlock> find_blocks(std::span<const std::byte> bytes, const FileSpot& where) {
  std::vector<TileBlock> blocks;
  std::size_t offset = 0;
  while (bytes.size() - offset >= kBlockHeadSize) {
    const BlockHead head = decode_block_head(bytes.subspan(offset).first<kBlockHeadSize>(), where);
    const std::size_t size = kBlockHeadSize + head.stored_size;
    if (size > bytes.size() - offset) break;
    blocks.push_back({offset, size, points_of(head)});
    offset += size;
  }
  return blocks;
}

void decode_points(std::span<const std::byte> block, const FileSpot& where, PointBlock& points) {
  if (block.size() < kBlockHeadSize) throw BadInput(where, "the block is cut short");
  const BlockHead head = decode_block_head(block.first<kBlockHeadSize>(), where);
  if (head.stored_size != block.size() - kBlockHeadSize) {
    throw BadInput(where, "the block has another size than its head says");
  }
  const std::size_t count = points_of(head);
  if (count > PointBuffer::kChunk) throw BadInput(where, "the block has too many points");
  std::vector<std::byte> content;
  decode_block(head, block.subspan(kBlockHeadSize), content, where);
  ColumnReader columns(content, where);
  points.points.resize(count);
  std::vector<double> column;
  for (int k = 0; k < 3; ++k) {
    columns.read(count, column);
    for (std::size_t i = 0; i < count; ++i) points.points[i][k] = column[i];
  }
  points.index.clear();
  if ((head.kind & kIndexed) != 0) columns.read(count, points.index);
  columns.expect_end();
}

void decode_all_points(std::span<const std::byte> blocks, const FileSpot& where,
                       PointBlock& points) {
  points.clear();
  PointBlock some;
  while (!blocks.empty()) {
    if (blocks.size() < kBlockHeadSize) throw BadInput(where, "a block is cut short");
    const BlockHead head = decode_block_head(blocks.first<kBlockHeadSize>(), where);
    const std::size_t size =
        std::min<std::size_t>(blocks.size(), kBlockHeadSize + head.stored_size);
    decode_points(blocks.first(size), where, some);
    points.points.insert(points.points.end(), some.points.begin(), some.points.end());
    points.index.insert(points.index.end(), some.index.begin(), some.index.end());
    blocks = blocks.subspan(size);
  }
}

}  // namespace spillway::detail
