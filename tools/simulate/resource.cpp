#include "tools/simulate/resource.h"

#include <algorithm>
#include <array>
#include <limits>

namespace spillway::command {
namespace {

constexpr std::array kResources = {Resource::kCores,  Resource::kMemory,  Resource::kFetch,
                                   Resource::kAppend, Resource::kSpill,   Resource::kWrite,
                                   Resource::kDisk,   Resource::kBatches, Resource::kTiles,
                                   Resource::kRoom,   Resource::kLoading, Resource::kTopMerges,
                                   Resource::kEnds};
constexpr std::array<std::string_view, kResources.size()> kNames = {
    "cores",          "memory for threads",
    "fetching",       "appending",
    "spilling",       "writing",
    "disk",           "batches",
    "room for tiles", "room for output",
    "loading tiles",  "merges of tiles",
    "start and end"};

}  // namespace

std::span<const Resource> all_resources() { return kResources; }

std::string_view name_of(Resource resource) { return kNames[static_cast<std::size_t>(resource)]; }

void make_free(Resource resource, RunModel& run) {
  switch (resource) {
    case Resource::kCores:
    case Resource::kDisk:
      break;
    case Resource::kMemory:
      run.limits.threads = std::numeric_limits<unsigned>::max();
      break;
    case Resource::kFetch:
      for (BatchCost& batch : run.batches) batch.fetch = 0;
      break;
    case Resource::kAppend:
      for (BatchCost& batch : run.batches) batch.append = 0;
      break;
    case Resource::kSpill:
      for (BatchCost& batch : run.batches) batch.write = 0;
      break;
    case Resource::kWrite:
      for (NodeCost& cost : run.costs) {
        for (PartCost& part : cost.parts) part.write = 0;
      }
      break;
    case Resource::kBatches:
      run.limits.batches = run.batches.size();
      break;
    case Resource::kTiles:
      run.limits.loaded_points = std::numeric_limits<std::uint64_t>::max();
      break;
    case Resource::kRoom:
      run.limits.waiting_bytes = std::numeric_limits<std::uint64_t>::max();
      break;
    case Resource::kLoading:
      for (NodeCost& cost : run.costs) {
        cost.read = cost.decode = cost.arrange = 0;
        cost.divide = {};
      }
      break;
    case Resource::kTopMerges:
      for (const RunNode& node : run.nodes) {
        if (node.children.empty()) continue;
        PartCost& merge = run.costs[node.cost].parts.front();
        merge.work = {};
        merge.settle = 0;
      }
      break;
    case Resource::kEnds:
      run.begin = run.end = 0;
      break;
  }
}

SimulatedCores make_free(Resource resource, SimulatedCores on, const RunModel& run) {
  if (resource == Resource::kCores) on.cores = std::max(on.cores, run.limits.threads);
  if (resource == Resource::kDisk) on.disk_speed = 0;
  return on;
}

}  // namespace spillway::command
