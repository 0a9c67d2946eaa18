#include "stream/memory_plan.h"

#include <fmt/format.h>

#include <algorithm>

#include "src/error.h"

namespace spillway {
namespace {

/// What memory is needed for, by dimension; measured, see docs/performance.md.
struct Costs {
  std::size_t leaf_bytes;     ///< a point: triangulation of a leaf
  std::size_t tile_bytes;     ///< a point: two loaded tiles and output that waits for its turn
  std::size_t good_leaf;      ///< leaves larger than this are slower
  std::size_t small_leaf;     ///< leaves smaller than this lose too much to merging
  std::uint64_t least_limit;  ///< below this nothing works well
};

constexpr std::uint64_t kMiB = std::uint64_t{1} << 20;
constexpr Costs kPlane{400, 96, 32'768, 4'096, 32 * kMiB};
constexpr Costs kSpace{1'200, 224, 262'144, 8'192, 96 * kMiB};

constexpr double kBufferShare = 0.4;
constexpr double kTileShare = 0.4;
constexpr double kWaitingShare = 0.1;
constexpr double kLeafShare = 0.08;   // of one thread
constexpr double kLeavesShare = 0.4;  // of all threads
constexpr std::size_t kBufferedPointBytes = 24;
/// So many leaves are enough for every thread.
constexpr std::uint64_t kEnoughLeaves = 16;

const Costs& costs_of(int dimension) { return dimension == 2 ? kPlane : kSpace; }

std::size_t share(std::uint64_t limit, double part, std::size_t bytes_each) {
  return static_cast<std::size_t>(static_cast<double>(limit) * part) / bytes_each;
}

}  // namespace

MemoryPlan plan_memory(std::uint64_t limit, int dimension, unsigned wanted_threads) {
  const Costs& costs = costs_of(dimension);
  if (limit < costs.least_limit) {
    throw UsageError(fmt::format("--memory is too small: {} MiB are the least that will do{}",
                                 costs.least_limit / kMiB,
                                 dimension == 3 ? " in three dimensions" : ""));
  }
  MemoryPlan plan;
  plan.buffered_points = share(limit, kBufferShare, kBufferedPointBytes);
  plan.tile_capacity = share(limit, kTileShare, costs.tile_bytes);
  plan.leaf_size =
      std::min({costs.good_leaf, share(limit, kLeafShare, costs.leaf_bytes), plan.tile_capacity});
  plan.waiting_bytes = share(limit, kWaitingShare, 1);
  const std::size_t most = share(limit, kLeavesShare, costs.leaf_bytes * plan.leaf_size);
  plan.threads = static_cast<unsigned>(std::clamp<std::size_t>(most, 1, wanted_threads));
  return plan;
}

std::size_t leaf_size_for(std::uint64_t points, int dimension, const MemoryPlan& plan) {
  return std::clamp<std::size_t>(points / kEnoughLeaves,
                                 std::min(costs_of(dimension).small_leaf, plan.leaf_size),
                                 plan.leaf_size);
}

}  // namespace spillway
