#pragma once
// The seam to LZ4: blocks, which Spillway's own files are made of, and the frames that the lz4 tool
// writes.

#include <cstddef>
#include <ios>
#include <memory>
#include <span>

#include "src/rooms.h"

namespace spillway::formats {

/// Compresses `content` (less than 2 GiB) into `room` and returns how many bytes it took; 0 if it
/// does not fit.
std::size_t lz4_compress(std::span<const std::byte> content, std::span<std::byte> room);

/// Decompresses a block. False if it is corrupt or does not fill `content` exactly.
bool lz4_decompress(std::span<const std::byte> compressed, std::span<std::byte> content);

/// Decompresses frames, one after another, piece by piece.
class Lz4FrameDecoder {
 public:
  Lz4FrameDecoder();
  ~Lz4FrameDecoder();
  Lz4FrameDecoder(const Lz4FrameDecoder&) = delete;
  Lz4FrameDecoder& operator=(const Lz4FrameDecoder&) = delete;

  struct Progress {
    std::size_t consumed = 0;
    std::size_t produced = 0;
  };

  /// Decompresses as much as there is and fits. Throws std::ios_base::failure for corrupt data.
  Progress decode(std::span<const char> compressed, std::span<char> content);

  /// Whether all that was decoded are whole frames, at least one.
  [[nodiscard]] bool complete() const { return wanted_ == 0; }

 private:
  struct Context;

  std::unique_ptr<Context> context_;
  std::size_t wanted_ = 1;  // 0 between frames
};

}  // namespace spillway::formats
