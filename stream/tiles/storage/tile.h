#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <vector>

#include "formats/disk/scratch_folder.h"
#include "formats/state/state_reader.h"
#include "formats/state/state_writer.h"
#include "src/error.h"
#include "src/geometry/box.h"
#include "stream/points/point_buffer.h"
#include "stream/tiles/storage/tile_segment.h"

namespace spillway::stream {

/// Points that wait, side by side in the order of their arrival.
struct HeldPoints {
  PointBuffer buffer{};
  Box<3> box{};
  std::optional<std::uint64_t> arrival{};  ///< of the first, if there are later points
  std::uint64_t run = 0;

  /// An arrival after all others, and after that of what came last.
  static constexpr std::uint64_t kAfterAll = std::numeric_limits<std::uint64_t>::max();
  /// What waits without an arrival came last.
  [[nodiscard]] std::uint64_t arrival_or_last() const { return arrival.value_or(kAfterAll - 1); }

  template <typename State>
  void state(State& state) {
    state(box, arrival, run);
    buffer_state(state);
  }

 private:
  void buffer_state(StateWriter& state);
  void buffer_state(StateReader& state);
};

/// What is known of a tile while it gets points.
struct Tile {
  Box<3> box;
  std::uint64_t points = 0;
  double expected = 0;           ///< points of segments left over above that are still to come
  Box<3> expected_box{};         ///< where they lie
  std::vector<HeldPoints> held;  ///< a run each; without an arrival it came last
  std::optional<std::uint64_t> last_left_over{};  ///< the last arrival of what was, above
  std::vector<TileSegment> segments;
  std::shared_ptr<ScratchFile> file;
  std::uint32_t spills = 0;  ///< to the file
  std::uint64_t used = 0;    ///< the last batch that had points of it
  std::uint64_t cut_at = 0;  ///< how many cuts had been made when it came about
  std::uint32_t cell = 0;    ///< of the plan
  bool hollow = false;       ///< its points, as far as is known, lie on curves or surfaces

  [[nodiscard]] std::size_t room() const;     ///< of what is held, in points
  [[nodiscard]] std::size_t waiting() const;  ///< points held
  [[nodiscard]] std::uint64_t held_bytes() const;

  template <typename State>
  void state(State& state) {
    state(box, points, expected, expected_box, held, last_left_over, segments);
    state.file(file);
    state(spills, used, cut_at, cell, hollow);
  }
};

/// A tile and its number.
struct NumberedTile {
  std::uint32_t number = 0;
  Tile tile;

  template <typename State>
  void state(State& state) {
    state(number, tile);
  }
};

/// Points on their way from one tile's buffer to its file.
struct Spill {
  PointBuffer points;
  std::shared_ptr<FileStretch> stretch;
  std::uint64_t count = 0;
  std::vector<std::byte> bytes;
  std::shared_ptr<CellSketch> sketch;  ///< to be filled, or none
};

/// A tile's points as they lay in the tree: on the disk, encoded, and in memory.
struct StoredTile {
  struct Segment {
    std::vector<std::byte> bytes;
    FileSpot where;  ///< of the bytes, for messages
    PointBuffer buffer;
  };
  std::vector<Segment> segments;
  std::uint64_t points = 0;
  /// Of points that are one vertex, and more than a tile has memory for, all but one: they are not
  /// among the points.
  std::uint64_t left_out = 0;

  [[nodiscard]] std::uint64_t held_bytes() const;  ///< of points in memory that are not encoded
};

}  // namespace spillway::stream
