#pragma once

#include <algorithm>
#include <cstddef>
#include <utility>

#include "src/delaunay/common/working_memory.h"
#include "src/delaunay/kernel_3d/cells.h"
#include "src/runtime/work_lease.h"

namespace spillway::delaunay::kernel_3d {

/// Where the cells of a base case lie: a slab, of which a lease may allow a part only.
class CellMemory {
 public:
  /// `lease`, if there is one, covers `usual` cells so far.
  CellMemory(Slab& slab, std::size_t usual, WorkLease* lease)
      : slab_(&slab), lease_(lease), leased_(usual) {}

  /// The array, with room for at least so many cells.
  CellArray first(std::size_t cells) {
    leased_ = std::max(leased_, cells);
    return CellArray(slab_->reserve(cells * sizeof(Cell)));
  }

  /// Cells that there is room for.
  [[nodiscard]] std::size_t capacity() const {
    const std::size_t room = std::min(slab_->capacity() / sizeof(Cell), CellArray::kMaxCells);
    return lease_ == nullptr ? room : std::min(room, leased_);
  }

  /// What one of many cells takes, with the room to spare.
  static constexpr double kBytesOfCell = 1.25 * sizeof(Cell);

  /// Makes room for `cells` cells and some more, of which `used` stay what they are. Throws Failure
  /// (kOutOfBudget) where the lease cannot grow.
  CellArray grow(std::size_t cells, std::size_t used, const WorkForecast& forecast) {
    const std::size_t wanted = std::min(cells + cells / 4, CellArray::kMaxCells);
    if (lease_ != nullptr && wanted > leased_) {
      release_kept_slabs();  // no lease covers what nobody uses
      lease_->grow((wanted - leased_) * sizeof(Cell) + std::exchange(ends_, 0), forecast);
      leased_ = wanted;
    }
    return CellArray(slab_->grow(wanted * sizeof(Cell), used * sizeof(Cell)));
  }

 private:
  Slab* slab_;
  WorkLease* lease_;
  std::size_t leased_;  ///< cells
  /// Once, for all but the cells: what huge pages take at the ends of an array that grows and
  /// moves, and what the allocator keeps of freed memory meanwhile; measured.
  std::size_t ends_ = std::size_t{14} << 20;
};

}  // namespace spillway::delaunay::kernel_3d
