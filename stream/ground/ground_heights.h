#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <memory>
#include <mutex>
#include <span>
#include <utility>
#include <vector>

#include "formats/disk/scratch_folder.h"
#include "src/terrain/unlocated_points.h"
#include "stream/ground/shared_scratch.h"

namespace spillway::stream {

/// The height of the ground below each point, by the points' numbers: found in any order, asked for
/// in ascending order. Numbers fall into stretches; of each what was found waits in memory or lies
/// in a scratch file until it is asked for.
class GroundHeights {
 public:
  /// Numbers are below `numbers`. `memory`: bytes for what waits; `scratch` must outlive it.
  GroundHeights(std::uint64_t numbers, std::uint64_t memory, ScratchFolder& scratch);

  /// By any number of threads at once. Each number comes once at most.
  void add(std::span<const NumberedHeight> found);

  /// Replaces `heights` by those of `count` numbers from the first one on, not a number where none
  /// has come. After the last add(), by any number of threads at once.
  void read(std::uint64_t first, std::size_t count, std::vector<double>& heights) const;

  [[nodiscard]] std::uint64_t spilled_bytes() const { return spilled_.size(); }

 private:
  /// Heights on the disk: so many places in their stretch, and so many heights.
  struct Spilled {
    std::uint64_t places = 0;   ///< where they begin
    std::uint64_t heights = 0;  ///< likewise
    std::size_t count = 0;
  };
  struct Stretch {
    std::mutex mutex;  ///< guards the others while heights come
    std::vector<std::uint32_t> places;
    std::vector<double> heights;
    std::vector<Spilled> spilled;
  };
  using Loaded = std::shared_ptr<const std::vector<double>>;

  void put(std::size_t number, std::span<const NumberedHeight> some);
  void spill(Stretch& stretch);
  [[nodiscard]] Loaded loaded(std::uint64_t stretch) const;
  [[nodiscard]] std::vector<double> load(const Stretch& stretch) const;

  std::uint64_t stretch_numbers_;
  std::uint64_t stretch_count_;
  std::size_t most_waiting_;  ///< of a stretch
  std::unique_ptr<Stretch[]> stretches_;
  SharedScratch spilled_;
  mutable std::mutex loaded_mutex_;                              ///< guards the next one
  mutable std::deque<std::pair<std::uint64_t, Loaded>> loaded_;  ///< those asked for last
};

}  // namespace spillway::stream
