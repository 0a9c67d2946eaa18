#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <vector>

#include "formats/disk/scratch_folder.h"
#include "src/geometry/box.h"
#include "stream/tiles/storage/cell_sketch.h"

namespace spillway::stream {

/// Where bytes that follow each other in a scratch file lie, or will lie: the file grows by them in
/// the order in which they are spilled, but later.
class FileStretch {
 public:
  FileStretch() = default;
  explicit FileStretch(std::shared_ptr<ScratchFile> file) : file_(std::move(file)) {}

  [[nodiscard]] ScratchFile& file() const { return *file_; }
  [[nodiscard]] std::uint64_t offset() const { return offset_; }
  [[nodiscard]] std::uint64_t size() const { return size_; }

  /// Writes the bytes to the end of the file. `mutex` is held for what other threads look at.
  void append(std::span<const std::byte> bytes, std::mutex& mutex);

  /// Becomes a part of the stretch before it. Under the mutex.
  void join(const std::shared_ptr<FileStretch>& before);

  /// Once all has been written.
  template <typename State>
  void state(State& state) {
    state.file(file_);
    state(offset_, size_);
  }

 private:
  void count(std::uint64_t offset, std::uint64_t bytes);

  std::shared_ptr<ScratchFile> file_;
  std::uint64_t offset_ = 0;
  std::uint64_t size_ = 0;
  std::shared_ptr<FileStretch> joined_;  ///< the stretch that it has become a part of
};

/// Points of a tile that lie on the disk side by side.
struct TileSegment {
  std::shared_ptr<FileStretch> stretch;
  std::uint32_t first_spill = 0;  ///< of its file: how many came before
  std::uint32_t end_spill = 0;
  std::uint64_t points = 0;
  /// Points of a tile that came earlier have lower ones. The segment's points have as many from
  /// this one on as there are: those of its parts lie within.
  std::uint64_t arrival = 0;
  bool follows = false;  ///< no other points that are dealt again come between it and the last
  Box<3> box;
  /// Together of all its points, complete once these have been encoded; or none.
  std::vector<std::shared_ptr<const CellSketch>> sketches{};

  /// No part of it has a later one. A segment has points.
  [[nodiscard]] std::uint64_t last_arrival() const { return arrival + points - 1; }

  template <typename State>
  void state(State& state) {
    state(stretch, first_spill, end_spill, points, arrival, follows, box, sketches);
  }
};

/// Joins neighbours in `segments`, those of a tile in the order of their arrival, until at most
/// `most` are left, or no two of them lie side by side. Those first that lie close together, and
/// have few points. Under the mutex of FileStretch::append().
void join_segments(std::vector<TileSegment>& segments, std::size_t most, int dimension);

/// The same for a tile that is cut no more, in one pass: joins all neighbours that lie side by
/// side, unless points that wait came between them: apart(arrival, later arrival) tells.
void join_all_segments(std::vector<TileSegment>& segments,
                       const std::function<bool(std::uint64_t, std::uint64_t)>& apart);

}  // namespace spillway::stream
