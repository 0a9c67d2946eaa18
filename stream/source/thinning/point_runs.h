#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <queue>
#include <span>
#include <utility>
#include <vector>

#include "formats/disk/scratch_folder.h"
#include "src/geometry/framed_point.h"

namespace spillway::stream {

/// A point, what belongs to it, and its place among others.
struct RunPoint {
  std::uint64_t order;
  std::uint64_t index;
  std::uint64_t number;  ///< by which its attributes are found
  LatticePoint point;
};

/// Sorts points on the disk: takes sorted runs and gives their points merged. If there are so many
/// runs that a piece of each does not fit into memory, some become one before.
class PointRuns {
 public:
  /// `memory`: bytes for pieces of runs that are being merged; two fit in any case. `scratch` must
  /// outlive it.
  PointRuns(std::uint64_t memory, ScratchFolder& scratch);

  /// Begins a run of points in ascending order; no two points have the same. append() adds to it.
  void begin_run();
  void append(std::span<const RunPoint> sorted);

  /// After the last append(): replaces `points` by the next ones of all runs in ascending order, so
  /// many at most. False at the end.
  bool next(std::vector<RunPoint>& points, std::size_t most);

 private:
  struct Run {
    std::shared_ptr<ScratchFile> file;
    std::uint64_t begin;  ///< in the file
    std::uint64_t end;
  };

  /// Reads several runs at the same time.
  class Merge {
   public:
    explicit Merge(std::span<const Run> runs);
    bool next(std::vector<RunPoint>& points, std::size_t most);

   private:
    struct Cursor {
      Run rest;                     ///< what is still to be read
      std::vector<RunPoint> piece;  ///< what was read
      std::size_t place = 0;        ///< in the piece
    };
    using Head = std::pair<std::uint64_t, std::size_t>;  // the order of a cursor's next point

    void enter(std::size_t number);

    std::vector<Cursor> cursors_;
    std::priority_queue<Head, std::vector<Head>, std::greater<>> heads_;
  };

  void merge_some();

  ScratchFolder& scratch_;
  std::size_t most_at_a_time_;
  std::vector<Run> runs_;
  std::optional<Merge> merge_;
};

}  // namespace spillway::stream
