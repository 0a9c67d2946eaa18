#pragma once

#include <cstddef>
#include <span>

#include "src/rooms.h"

namespace spillway::formats {

/// The bytes of chunks, span by span.
class LazBytes {
 public:
  virtual ~LazBytes() = default;
  /// The bytes after those given out so far, valid until the next call; empty at the end.
  virtual std::span<const std::byte> more() = 0;
};

}  // namespace spillway::formats
