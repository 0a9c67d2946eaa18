#pragma once
// Compressed blocks in memory, whose sizes other programs wrote down.

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "src/rooms.h"

namespace spillway::formats {

/// How a block is compressed: by zlib (RFC 1950), as a block of LZ4, or as a stream of xz.
enum class BlockCompression { kZlib, kLz4, kXz };

/// Decompresses a block into `content`. False if it is corrupt or its content has not `size` bytes.
/// Memory grows with what is decompressed, not with `size`.
bool decompress_block(BlockCompression compression, std::span<const std::byte> compressed,
                      std::uint64_t size, std::vector<std::byte>& content);

}  // namespace spillway::formats
