#pragma once

#include <spillway/choices.h>
#include <array>

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "formats/disk/scratch_folder.h"
#include "formats/points/common/point_reader.h"
#include "src/geometry/framed_point.h"
#include "src/geometry/lattice.h"
#include "stream/points/encoded_points.h"
#include "stream/points/point_buffer.h"
#include "stream/source/thinning/point_runs.h"

namespace spillway::stream {

/// The part of a memory limit that thinning may take, as its divisor: points that wait to be
/// spilled and the last cells are in memory at the same time.
inline constexpr std::uint64_t kThinningShare = 4;

/// Is told how far the points have come that found no room in memory.
struct ThinningProgress {
  std::function<void()> begin = [] {};
  std::function<void(std::uint64_t done, std::uint64_t points)> update = [](std::uint64_t,
                                                                            std::uint64_t) {};
  std::function<void(std::uint64_t points)> end = [](std::uint64_t) {};
};

struct ThinningOptions {
  double cell = 1;  ///< side, in output units; the grid has a corner at the origin
  ThinChoice choice = ThinChoice::kFirst;
  /// Axes that have cells: 2 or 3. kLowest and kHighest look at columns, so always 2.
  int dimension = 2;
  std::optional<IntegerLattice> lattice{};  ///< the points come as integers of it
  std::uint64_t memory = 0;                 ///< bytes to keep to, a few MiB at least
  ThinningProgress progress{};
};

/// Keeps one point of each cell of a grid, in bounded memory. Cells are met in the order of the
/// points; those that come while there is room stay in a hash table, and see all their points. The
/// points of the others go to files, by a hash of the cell, and each file is thinned afterwards in
/// the same way. What is kept of the files is sorted on the disk, so that all points come in the
/// order in which their cells were met. Neither which points are kept nor their order depends on
/// the memory, and which are kept does not even depend on the order of points.
class Thinning {
 public:
  /// `scratch` must outlive it.
  Thinning(const ThinningOptions& options, ScratchFolder& scratch);

  /// Points come with attributes of this layout. To be called before any comes.
  void carry(const AttributeLayout& attributes);

  /// Takes points, each with its index; indices ascend. Throws Failure if cells are too small to be
  /// counted.
  void add(const PointBlock& block);

  /// After the last add(): replaces `block` by the next kept points, in the order in which their
  /// cells were met; false at the end. Blocks are full but for the last. The call that needs points
  /// from files thins all of these.
  bool next(PointBlock& block);

  /// Points that lost against another one of their cell so far.
  [[nodiscard]] std::uint64_t dropped() const { return dropped_; }

 private:
  using Cell = std::array<double, 3>;  // whole numbers

  struct Candidate {
    LatticePoint point;
    std::uint64_t index;
  };
  /// Where a candidate is found by its cell.
  struct Slot {
    std::uint32_t hash = 0;    ///< lower half of that of its cell
    std::uint32_t number = 0;  ///< of the candidate + 1; 0: free
  };
  /// Points of cells for which there was no room.
  struct Bucket {
    PointBuffer buffer;
    std::unique_ptr<ScratchFile> file;
    std::vector<EncodedBlock> blocks;
    unsigned level = 0;  ///< passes that its points have been through
  };

  [[nodiscard]] WorldPoint world(const LatticePoint& point) const;
  [[nodiscard]] Cell cell_of(const WorldPoint& world) const;
  [[nodiscard]] bool better(const Candidate& a, const Candidate& b) const;
  void offer(const Candidate& candidate, const std::byte* attributes);
  void grow();
  void put_aside(const Candidate& candidate, const std::byte* attributes, std::uint64_t hash);
  void write(Bucket& bucket);
  void end_pass();
  void run_pass(Bucket bucket);
  void work_off_files();
  void keep_candidates();
  void take_kept();
  bool has_more();

  ThinningOptions options_;
  ScratchFolder& scratch_;
  std::size_t record_size_ = 0;              ///< bytes of a point's attributes
  std::size_t chunk_ = PointBuffer::kChunk;  ///< points that are put aside to a file at a time
  std::size_t block_points_;                 ///< of those that are given
  std::size_t capacity_;                     ///< cells in memory
  std::vector<Candidate> candidates_;        ///< in the order in which their cells were met
  std::vector<std::byte> attributes_;        ///< of these
  std::vector<std::uint64_t> met_;           ///< of points from files: the first index of each cell
  std::vector<Slot> slots_;                  ///< as many as a power of 2, half full at most
  std::vector<Bucket> buckets_;              ///< of the pass that is going on
  std::vector<Bucket> waiting_;
  std::optional<PointRuns> kept_;  ///< of the points from files
  std::unique_ptr<ScratchFile> kept_attributes_;
  std::uint64_t kept_count_ = 0;  ///< points that these are of
  std::vector<RunPoint> sorted_;  ///< that go into it or come out of it
  unsigned level_ = 0;
  bool passing_ = true;    ///< candidates_ may still get better
  std::size_t given_ = 0;  ///< of candidates_
  std::uint64_t dropped_ = 0;
  std::uint64_t put_aside_ = 0;  ///< points, in the first pass
  std::uint64_t done_ = 0;       ///< of these
};

}  // namespace spillway::stream
