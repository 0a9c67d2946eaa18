#pragma once

#include <cstddef>
#include <cstdint>

#include "formats/meshes/common/stream_vertices.h"

namespace spillway::formats {

/// Checks for a reader that blocks import only vertices that are live, each once.
class ImportCheck {
 public:
  /// Notes that the block in work uses an earlier vertex. False if that is not announced, is
  /// finalized, or is imported by the block already.
  bool import(std::uint64_t number) {
    std::uint64_t* const last_block = live_.find(number);
    if (last_block == nullptr || *last_block == block_) return false;
    *last_block = block_;
    return true;
  }

  /// Ends the block in work, whose short numbers are known to stand for vertices.
  void settle(const MeshStreamBlock& block) {
    live_.settle(block, [this](std::uint32_t) { return block_; });
    ++block_;
  }

  /// Number of vertices that may be imported.
  [[nodiscard]] std::size_t live() const { return live_.size(); }

 private:
  StreamVertices<std::uint64_t> live_;  ///< the block that has it last
  std::uint64_t block_ = 0;
};

}  // namespace spillway::formats
