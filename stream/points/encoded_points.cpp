#include "stream/points/encoded_points.h"

#include <fmt/format.h>

#include <algorithm>

#include "formats/blocks/block.h"
#include "formats/blocks/columns.h"
#include "src/error.h"

namespace spillway::stream {
namespace {

/// A block's kind is the number of its points, and what they have besides coordinates.
constexpr std::uint32_t kIndexed = 1;
constexpr std::uint32_t kHasAttributes = 2;
constexpr std::uint32_t kOnePoint = 4;

std::uint32_t kind_of(const PointsView& points) {
  return kOnePoint * static_cast<std::uint32_t>(points.size()) +
         (points.index.empty() ? 0 : kIndexed) + (points.attributes.empty() ? 0 : kHasAttributes);
}

std::size_t points_of(const BlockHead& head) { return head.kind / kOnePoint; }

}  // namespace

void refuse_large_records(std::size_t record_size) {
  if (record_size <= PointBuffer::kMostRecord) return;
  throw InvalidArgument(
      fmt::format("the attributes of a point take {} bytes, and {} are the most: choose fewer",
                  record_size, PointBuffer::kMostRecord));
}

void append_points(std::vector<std::byte>& bytes, const PointsView& points) {
  std::vector<std::byte> content;
  std::vector<double> column(points.size());
  for (int k = 0; k < 3; ++k) {
    for (std::size_t i = 0; i < points.size(); ++i) column[i] = points.points[i][k];
    append_column(content, column);
  }
  if (!points.index.empty()) append_column(content, points.index);
  if (!points.attributes.empty()) {
    append_byte_planes(content, points.attributes, points.record_size());
  }
  append_block(bytes, kind_of(points), content);
}

void append_all_points(std::vector<std::byte>& bytes, const PointsView& points) {
  for (std::size_t i = 0; i < points.size(); i += PointBuffer::kChunk) {
    append_points(bytes, points.subview(i, std::min(PointBuffer::kChunk, points.size() - i)));
  }
}

std::vector<EncodedBlock> encode_points(PointBuffer& points, std::vector<std::byte>& bytes) {
  std::vector<EncodedBlock> blocks;
  points.drain_in_chunks([&](const PointBlock& some) {
    const std::size_t begin = bytes.size();
    append_points(bytes, PointsView::of(some));
    blocks.push_back({begin, bytes.size() - begin, some.size()});
  });
  return blocks;
}

std::vector<EncodedBlock> find_blocks(std::span<const std::byte> bytes, const FileSpot& where) {
  std::vector<EncodedBlock> blocks;
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
  points.attributes.clear();
  if ((head.kind & kIndexed) != 0) columns.read(count, points.index);
  if ((head.kind & kHasAttributes) != 0 && count > 0) {
    columns.read_byte_planes(count, points.attributes);
  }
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
    PointsView::of(some).append_to(points);
    blocks = blocks.subspan(size);
  }
}

}  // namespace spillway::stream
