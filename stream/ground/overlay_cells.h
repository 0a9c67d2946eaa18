#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <span>
#include <vector>

#include "formats/disk/scratch_folder.h"
#include "src/geometry/box.h"
#include "src/terrain/overlay_volume.h"
#include "stream/ground/shared_scratch.h"

namespace spillway::stream {

/// The triangles of two surfaces in the cells of a grid, which they come to in any order: a join of
/// both by cells (after J. Patel, D. DeWitt, "Partition based spatial-merge join", SIGMOD 1996). A
/// triangle is kept by all cells that its box meets; when memory is short, by the fullest ones on
/// the disk.
class OverlayCells {
 public:
  /// `extent` is where most triangles will lie, `triangles` about how many, `memory` bytes to keep
  /// to, `threads` how many will work at a time. `scratch` must outlive it.
  OverlayCells(const Box<2>& extent, std::uint64_t triangles, std::uint64_t memory,
               unsigned threads, ScratchFolder& scratch);
  ~OverlayCells();

  /// Takes triangles of the first (0) or the second (1) surface, corners in canonical order. By any
  /// number of threads at once.
  void add(std::size_t surface, std::span<const Triangle> triangles);

  /// What lies between both surfaces, by all threads; exact sums, so that neither their number nor
  /// the cells make a difference. `progress` is told how many cells are done.
  [[nodiscard]] VolumeSums between(const std::function<void(std::uint64_t cells)>& progress);

  [[nodiscard]] std::uint64_t cells() const { return rows_ * columns_; }
  [[nodiscard]] std::uint64_t spilled_bytes() const { return spilled_.size(); }

 private:
  struct Cell;
  struct Place {
    std::size_t row = 0;
    std::size_t column = 0;
    bool operator==(const Place&) const = default;
  };

  [[nodiscard]] Place place_of(const Point<2>& p) const;
  void relieve();
  void add_between(std::span<const Triangle> first, std::span<const Triangle> second,
                   const Place& place, VolumeSums& sums) const;

  Box<2> extent_;
  std::uint64_t most_held_;  ///< bytes
  std::size_t joined_at_a_time_;
  std::size_t rows_ = 1;
  std::size_t columns_ = 1;
  std::unique_ptr<Cell[]> cells_;
  std::atomic<std::uint64_t> held_bytes_ = 0;
  std::mutex relief_mutex_;
  SharedScratch spilled_;
};

}  // namespace spillway::stream
