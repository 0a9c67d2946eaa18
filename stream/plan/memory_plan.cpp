#include "stream/plan/memory_plan.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "src/error.h"

namespace spillway::stream {
namespace {

/// What memory is needed for, by dimension; measured, see docs/performance-history.md.
struct Costs {
  std::size_t leaf_bytes;     ///< a point: triangulation of a leaf, and what is made of it
  std::size_t tile_bytes;     ///< a point: two loaded tiles and output that waits for its turn
  std::size_t good_tile;      ///< tiles larger than this are no faster
  std::size_t good_leaf;      ///< leaves larger than this are no faster
  std::size_t small_leaf;     ///< leaves smaller than this lose too much to merging
  std::size_t enough_leaves;  ///< that are enough for every thread
  double buffer_share;        ///< of the limit: for points that wait to be spilled
  double leaf_share;          ///< of the limit: for a leaf of one thread
  double leaves_share;        ///< of the limit: for those of all threads
  std::uint64_t least_limit;  ///< below this nothing works well
};

constexpr std::uint64_t kMiB = std::uint64_t{1} << 20;
constexpr Costs kPlane{.leaf_bytes = 400,
                       .tile_bytes = 108,
                       .good_tile = 750'000,
                       .good_leaf = 32'768,
                       .small_leaf = 4'096,
                       .enough_leaves = 16,
                       .buffer_share = 0.4,
                       .leaf_share = 0.08,
                       .leaves_share = 0.4,
                       .least_limit = 32 * kMiB};
constexpr Costs kSpace{.leaf_bytes = 800,
                       .tile_bytes = 224,
                       .good_tile = std::numeric_limits<std::size_t>::max(),
                       .good_leaf = 196'608,
                       .small_leaf = 16'384,
                       .enough_leaves = 8,
                       .buffer_share = 0.3,
                       .leaf_share = 0.135,
                       .leaves_share = 0.45,
                       .least_limit = 96 * kMiB};

/// With four dimensions and more a point has 32, 190 or 1,300 simplices, and a border is a large
/// part of a tile: few large leaves. Those whose simplices make a block of some 128 MiB are the
/// largest.
constexpr Costs higher(std::size_t leaf_bytes, std::size_t tile_bytes, std::size_t good_leaf,
                       std::uint64_t least_limit) {
  return {.leaf_bytes = leaf_bytes,
          .tile_bytes = tile_bytes,
          .good_tile = std::numeric_limits<std::size_t>::max(),
          .good_leaf = good_leaf,
          .small_leaf = good_leaf / 4,
          .enough_leaves = 2,
          .buffer_share = 0.2,
          .leaf_share = 0.25,
          .leaves_share = 0.5,
          .least_limit = least_limit};
}
constexpr std::array kHigher = {higher(5'000, 1'500, 262'144, 128 * kMiB),
                                higher(36'000, 8'000, 131'072, 256 * kMiB),
                                higher(300'000, 60'000, 16'384, 512 * kMiB)};

/// What is not shared out: gaps between what is in use, tables, and code that is loaded when it is
/// first run. More where points are read and tiles are triangulated at the same time.
constexpr std::uint64_t kReserve = 4 * kMiB;
constexpr std::uint64_t kEarlyReserve = 6 * kMiB;

constexpr double kTileShare = 0.4;
/// More full tiles than this are not made if larger ones will do: something is known of each.
constexpr std::uint64_t kManyTiles = 8192;
/// What buffers and tiles get of their shares if they are there at the same time.
constexpr double kEarlyShare = 0.75;
constexpr double kWaitingShare = 0.1;
constexpr double kSketchShare = 0.03;
constexpr std::size_t kBufferedPointBytes = 24;

/// How often the attributes of a point are in memory: in two loaded tiles and the output that
/// waits; in a leaf and what is made of it; in a batch as it was read and as it is dealt.
constexpr std::size_t kTileRecords = 3;
constexpr std::size_t kLeafRecords = 2;
constexpr std::size_t kBatchRecords = 2;

/// Batches of points: raw, and dealt.
constexpr double kBatchesShare = 0.35;
constexpr std::size_t kBatchPoints = 65'536;
constexpr std::size_t kBatchPointBytes = 58;
constexpr std::size_t kLeastBatches = 3;
/// ... beside tiles that are triangulated, with which threads go on meanwhile.
constexpr std::size_t kLeastEarlyBatches = 2;
constexpr std::size_t kEnoughBatches = 6;  // for few threads
constexpr std::size_t kBatchesOfThread = 2;

const Costs& costs_of(int dimension) {
  if (dimension > 3) return kHigher[static_cast<std::size_t>(dimension - 4)];
  return dimension == 2 ? kPlane : kSpace;
}

const char* dimensions_text(int dimension) {
  constexpr std::array kTexts = {"", " in three dimensions", " in four dimensions",
                                 " in five dimensions", " in six dimensions"};
  return kTexts[static_cast<std::size_t>(dimension - 2)];
}

std::size_t share(std::uint64_t limit, double part, std::size_t bytes_each) {
  return static_cast<std::size_t>(static_cast<double>(limit) * part) / bytes_each;
}

}  // namespace

MemoryPlan plan_memory(std::uint64_t limit, int dimension, unsigned wanted_threads,
                       std::uint64_t whole, bool early, std::size_t record_size) {
  const Costs& costs = costs_of(dimension);
  if (limit < costs.least_limit) {
    const double parts = static_cast<double>(std::max(whole, limit)) /
                         static_cast<double>(std::max(limit, std::uint64_t{1}));
    const auto least = static_cast<std::uint64_t>(
        std::ceil(static_cast<double>(costs.least_limit) / static_cast<double>(kMiB) * parts));
    throw TooSmallLimit(fmt::format("the memory limit is too small: {} MiB are the least{}", least,
                                    dimensions_text(dimension)),
                        {.enough = least * kMiB, .remedy = Remedy::kMemory});
  }
  MemoryPlan plan;
  limit -= early ? kEarlyReserve : kReserve;
  const double part = early ? kEarlyShare : 1;
  const std::size_t leaf_bytes = costs.leaf_bytes + kLeafRecords * record_size;
  plan.buffered_points = share(limit, part * costs.buffer_share, kBufferedPointBytes + record_size);
  plan.tile_room = share(limit, part * kTileShare, costs.tile_bytes + kTileRecords * record_size);
  plan.tile_points = std::min(plan.tile_room, costs.good_tile);
  plan.leaf_points =
      std::min({costs.good_leaf, share(limit, costs.leaf_share, leaf_bytes), plan.tile_points});
  plan.waiting_bytes = share(limit, kWaitingShare, 1);
  plan.sketch_bytes = dimension > 3 ? 0 : share(limit, kSketchShare, 1);
  plan.batches = std::clamp(
      share(limit, kBatchesShare, kBatchPoints * (kBatchPointBytes + kBatchRecords * record_size)),
      early ? kLeastEarlyBatches : kLeastBatches,
      std::max<std::size_t>(kEnoughBatches, kBatchesOfThread * wanted_threads));
  const std::size_t most = share(limit, costs.leaves_share, leaf_bytes * plan.leaf_points);
  plan.threads = static_cast<unsigned>(std::clamp<std::size_t>(most, 1, wanted_threads));
  return plan;
}

std::size_t tile_points_for(std::uint64_t points, const MemoryPlan& plan) {
  return std::clamp<std::size_t>(points / kManyTiles, plan.tile_points, plan.tile_room);
}

std::size_t leaf_points_for(std::uint64_t points, int dimension, const MemoryPlan& plan) {
  const Costs& costs = costs_of(dimension);
  return std::clamp<std::size_t>(points / costs.enough_leaves,
                                 std::min(costs.small_leaf, plan.leaf_points), plan.leaf_points);
}

unsigned threads_beside(std::uint64_t own, std::uint64_t limit, unsigned wanted_threads) {
  return plan_memory(limit - own, 2, wanted_threads).threads;
}

}  // namespace spillway::stream
