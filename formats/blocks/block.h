#pragma once
// Compressed blocks with checksums: what spill files and Spillway's own streams are made of.
// docs/formats-blocks.md has the layout.

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "src/error.h"

namespace spillway::formats {

/// What stands before a block's content.
struct BlockHead {
  std::uint32_t kind = 0;          ///< the user's own tag
  std::uint32_t content_size = 0;  ///< bytes, decompressed
  std::uint32_t stored_size = 0;   ///< bytes that follow the head
  bool compressed = false;         ///< LZ4, or as it is (where that is not longer)
  std::uint64_t checksum = 0;      ///< XXH3-64 of the head's other fields and the stored bytes
};

/// Size of an encoded head, in bytes.
inline constexpr std::size_t kBlockHeadSize = 24;

/// The largest content of one block; what claims more is corrupt.
inline constexpr std::size_t kLargestBlock = std::size_t{256} << 20;

/// LZ4 makes at most this many bytes of one.
inline constexpr std::uint64_t kLargestRatio = 255;

/// Appends a block, head and stored bytes, to `out`.
void append_block(std::vector<std::byte>& out, std::uint32_t kind,
                  std::span<const std::byte> content);

/// Decodes a head. Throws BadInput of `where` if it is none.
BlockHead decode_block_head(std::span<const std::byte, kBlockHeadSize> bytes,
                            const FileSpot& where);

/// Replaces `content` by a block's content. Throws BadInput of `where` if the checksum
/// does not fit or the content does not decompress to the size that the head tells.
void decode_block(const BlockHead& head, std::span<const std::byte> stored,
                  std::vector<std::byte>& content, const FileSpot& where);

}  // namespace spillway::formats
