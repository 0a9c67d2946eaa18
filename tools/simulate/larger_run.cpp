#include <algorithm>
#include <cmath>
#include <map>

#include "tools/simulate/core_simulation.h"

namespace spillway::command {
namespace {

/// Merges cannot grow faster than what is below them.
constexpr double kMostGrowth = 2;

double seconds_of(const PartCost& part) {
  return part.work.total_seconds() + part.settle + part.write;
}

/// By how much merges of tiles are larger than those one level below them: of the highest and the
/// lowest level, the means.
double growth_of(const RunModel& run) {
  struct Sum {
    double seconds = 0;
    double count = 0;
  };
  std::map<std::uint32_t, Sum> sums;
  std::vector<std::uint32_t> levels(run.nodes.size());
  for (std::size_t n = 0; n < run.nodes.size(); ++n) {
    const RunNode& node = run.nodes[n];
    if (node.children.empty()) continue;
    for (const std::uint32_t child : node.children) {
      levels[n] = std::max(levels[n], levels[child] + 1);
    }
    Sum& sum = sums[levels[n]];
    sum.seconds += seconds_of(run.costs[node.cost].parts.front());
    ++sum.count;
  }
  if (sums.size() < 2) return kMostGrowth;
  const auto& [low_level, low] = *sums.begin();
  const auto& [high_level, high] = *sums.rbegin();
  if (low.seconds <= 0) return kMostGrowth;
  const double ratio = (high.seconds / high.count) / (low.seconds / low.count);
  return std::clamp(std::pow(ratio, 1.0 / (high_level - low_level)), 1.0, kMostGrowth);
}

/// Copies of a run, and what merges them.
class Enlargement {
 public:
  Enlargement(const RunModel& run, std::uint32_t copies)
      : run_(run), copies_(copies), early_(std::ranges::any_of(run.nodes, [&](const RunNode& node) {
          return node.after_batches < run.read_batches;
        })) {}

  RunModel make() {
    large_ = run_;
    large_.points = run_.points * copies_;
    large_.batches.clear();
    large_.nodes.clear();
    const auto read = run_.batches.begin() + static_cast<std::ptrdiff_t>(run_.read_batches);
    for (std::uint32_t c = 0; c < copies_; ++c) {
      large_.batches.insert(large_.batches.end(), run_.batches.begin(), read);
    }
    large_.read_batches = large_.batches.size();
    for (std::uint32_t c = 0; c < copies_; ++c) {
      large_.batches.insert(large_.batches.end(), read, run_.batches.end());
    }
    growth_ = growth_of(run_);
    add_copies(0, copies_);
    return std::move(large_);
  }

 private:
  /// What is merged of the copies from `first` on.
  struct Merged {
    std::uint32_t root;
    std::uint32_t level;  ///< merges of copies
  };

  Merged add_copies(std::uint32_t first, std::uint32_t count) {
    if (count == 1) return {add_copy(first), 0};
    const Merged low = add_copies(first, count / 2);
    const Merged high = add_copies(first + count / 2, count - count / 2);
    const std::uint32_t level = std::max(low.level, high.level) + 1;
    return {add_merge(low, high, level), level};
  }

  std::uint32_t add_copy(std::uint32_t copy) {
    const auto offset = static_cast<std::uint32_t>(large_.nodes.size());
    for (RunNode node : run_.nodes) {
      for (std::uint32_t& child : node.children) child += offset;
      node.after_batches = early_ ? batch_of(node.after_batches, copy) : all_batches();
      large_.nodes.push_back(std::move(node));
    }
    return static_cast<std::uint32_t>(large_.nodes.size() - 1);
  }

  std::uint32_t add_merge(const Merged& low, const Merged& high, std::uint32_t level) {
    const auto cost = static_cast<std::uint32_t>(run_.costs.size()) + level - 1;
    while (large_.costs.size() <= cost) add_merge_cost();
    large_.nodes.push_back({.cost = cost,
                            .children = {low.root, high.root},
                            .after_batches = large_.nodes[high.root].after_batches});
    return static_cast<std::uint32_t>(large_.nodes.size() - 1);
  }

  /// That of a merge one level higher: the root's, or the last one's, but larger.
  void add_merge_cost() {
    const bool first = large_.costs.size() == run_.costs.size();
    const NodeCost& below = large_.costs[first ? run_.nodes.back().cost : large_.costs.size() - 1];
    PartCost merge = below.parts.back();  // of a run of one tile, the last merge in that
    merge.children = 0;
    merge.work = enlarge(merge.work, growth_);
    merge.settle *= static_cast<float>(growth_);
    merge.write *= static_cast<float>(growth_);
    merge.bytes = static_cast<std::uint32_t>(merge.bytes * growth_);
    NodeCost above;
    above.parts.push_back(std::move(merge));
    large_.costs.push_back(std::move(above));
  }

  [[nodiscard]] std::uint32_t batch_of(std::uint32_t after, std::uint32_t copy) const {
    const auto read = static_cast<std::uint32_t>(run_.read_batches);
    return copy * read + std::min(after, read);
  }
  [[nodiscard]] std::uint32_t all_batches() const {
    return static_cast<std::uint32_t>(large_.batches.size());
  }

  const RunModel& run_;
  const std::uint32_t copies_;
  const bool early_;
  double growth_ = 1;
  RunModel large_;
};

}  // namespace

RunModel enlarge(const RunModel& run, std::uint64_t points) {
  if (run.points == 0 || run.nodes.empty()) return run;
  const double copies = std::round(static_cast<double>(points) / static_cast<double>(run.points));
  if (copies <= 1) return run;
  return Enlargement(run, static_cast<std::uint32_t>(copies)).make();
}

}  // namespace spillway::command
