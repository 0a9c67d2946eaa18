#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "formats/meshes/common/mesh.h"

namespace spillway::formats {

/// The numbers of IdRuns, one after another.
class GlobalIds {
 public:
  /// `runs` must outlive it; for as many vertices as are asked for.
  explicit GlobalIds(std::span<const IdRange> runs) : runs_(runs) {}

  std::uint64_t next() {
    while (given_ == runs_.front().count) {
      runs_ = runs_.subspan(1);
      given_ = 0;
    }
    return runs_.front().first + given_++;
  }

 private:
  std::span<const IdRange> runs_;
  std::uint64_t given_ = 0;  // of the first run
};

/// Appends a vertex, to the last run if it goes on there.
inline void append_id(std::vector<IdRange>& runs, std::uint64_t id, std::uint64_t count = 1) {
  if (count == 0) return;
  if (!runs.empty() && runs.back().first + runs.back().count == id) {
    runs.back().count += count;
  } else {
    runs.push_back({id, count});
  }
}

}  // namespace spillway::formats
