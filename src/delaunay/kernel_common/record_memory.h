#pragma once

#include <algorithm>
#include <cstddef>
#include <utility>

#include "src/delaunay/common/working_memory.h"
#include "src/runtime/work_lease.h"

namespace spillway::delaunay::kernel {

/// Where the records of a base case lie: a slab, of which a lease may allow a part only. `Array`
/// gives them by number; it is made of where they begin, and can number kMostRecords.
template <typename Array>
class RecordMemory {
 public:
  using Record = typename Array::Record;

  /// `lease`, if there is one, covers `usual` records so far.
  RecordMemory(Slab& slab, std::size_t usual, WorkLease* lease)
      : slab_(&slab), lease_(lease), leased_(usual) {}

  /// The array, with room for at least so many records.
  Array first(std::size_t records) {
    leased_ = std::max(leased_, records);
    return Array(slab_->reserve(records * sizeof(Record)));
  }

  /// Records that there is room for.
  [[nodiscard]] std::size_t capacity() const {
    const std::size_t room = std::min(slab_->capacity() / sizeof(Record), Array::kMostRecords);
    return lease_ == nullptr ? room : std::min(room, leased_);
  }

  /// What one of many records takes, with the room to spare.
  static constexpr double kBytesOfRecord = 1.25 * sizeof(Record);

  /// Makes room for `records` records and some more, of which `used` stay what they are. Throws
  /// Failure (kOutOfBudget) where the lease cannot grow.
  Array grow(std::size_t records, std::size_t used, const WorkForecast& forecast) {
    const std::size_t wanted = std::min(records + records / 4, Array::kMostRecords);
    if (lease_ != nullptr && wanted > leased_) {
      release_kept_slabs();  // no lease covers what nobody uses
      lease_->grow((wanted - leased_) * sizeof(Record) + std::exchange(ends_, 0), forecast);
      leased_ = wanted;
    }
    return Array(slab_->grow(wanted * sizeof(Record), used * sizeof(Record)));
  }

 private:
  Slab* slab_;
  WorkLease* lease_;
  std::size_t leased_;  ///< records
  /// Once, for all but the records: what huge pages take at the ends of an array that grows and
  /// moves, and what the allocator keeps of freed memory meanwhile; measured.
  std::size_t ends_ = std::size_t{14} << 20;
};

}  // namespace spillway::delaunay::kernel
