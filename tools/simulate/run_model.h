#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "stream/plan/run_trace.h"
#include "tools/simulate/flat_task.h"

namespace spillway::command {

/// What a batch of points costs on its way to the tiles. Times are seconds of a processor.
struct BatchCost {
  float fetch = 0;   ///< one batch at a time, in order
  float deal = 0;    ///< decoding and dealing: many at a time
  float append = 0;  ///< one at a time, in order
  float encode = 0;  ///< of what is spilled: many at a time
  float write = 0;   ///< one at a time, in order
  std::uint32_t fetched_bytes = 0;
  std::uint32_t written_bytes = 0;
};

/// What a leaf of a tile costs, a merge in a tile, or a merge of tiles: it makes one block.
struct PartCost {
  FlatTask work{};
  float settle = 0;            ///< finding what is final, making and encoding its block
  float write = 0;             ///< of that block: one at a time, in order
  std::uint32_t bytes = 0;     ///< of the block
  std::uint32_t children = 0;  ///< that it merges: of those before it, the last ones
};

/// What a tile costs, or a merge of tiles, which has one part and no points to load.
struct NodeCost {
  std::uint64_t points = 0;  ///< that are loaded for it
  float read = 0;            ///< one tile at a time, while the one before is worked on
  std::uint64_t read_bytes = 0;
  float decode = 0;
  std::uint32_t decode_grains = 1;
  float arrange = 0;  ///< by one thread: all else before it is divided
  FlatTask divide{};
  std::vector<PartCost> parts{};  ///< in post-order
  float finish = 0;               ///< by one thread
};

/// A tile or a merge of tiles. Its number is its place in the output.
struct RunNode {
  std::uint32_t cost = 0;                 ///< of RunModel::costs
  std::vector<std::uint32_t> children{};  ///< by their numbers, which are below its own
  std::uint32_t after_batches = 0;        ///< of the run, after which it can be worked on
};

/// All that a run has to do, and in what order it must, as measured on one thread.
struct RunModel {
  double begin = 0;  ///< seconds before the first batch, by one thread
  std::vector<BatchCost> batches{};
  std::size_t read_batches = 0;  ///< the first of these; the others are dealt again after them
  std::vector<NodeCost> costs{};
  std::vector<RunNode> nodes{};  ///< in post-order of the trees that they make
  double end = 0;                ///< seconds after the last block, by one thread
  RunLimits limits{};
  double output_bytes = 1;  ///< of the output's file, for each byte of blocks
  std::uint64_t points = 0;

  /// What one core takes.
  [[nodiscard]] double total_seconds() const;
};

}  // namespace spillway::command
