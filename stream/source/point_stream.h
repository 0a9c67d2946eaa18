#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "formats/state/state_reader.h"
#include "formats/state/state_writer.h"
#include "src/geometry/box.h"
#include "src/geometry/lattice.h"
#include "stream/points/input_region.h"
#include "stream/points/point_feed.h"
#include "stream/source/point_filter.h"

namespace spillway::stream {

/// The points of a run as the pipeline takes them.
/// decode() gives them on lattice() if that is set, else in output coordinates.
class PointStream : public PointFeed {
 public:
  /// The lattice on which all points lie, if there is one.
  [[nodiscard]] virtual const std::optional<IntegerLattice>& lattice() const = 0;
  /// About how many points will come, where that can be told; rather too many.
  [[nodiscard]] virtual std::optional<std::uint64_t> expected() const = 0;
  /// Of all points, in the coordinates of decode(), where that is known.
  [[nodiscard]] virtual const std::optional<Box<3>>& extent() const = 0;

  /// Parts of the points of which is known where they lie, in the coordinates of decode(); none
  /// unless that is known of all points.
  [[nodiscard]] virtual std::span<const InputRegion> regions() const { return {}; }
  /// What is kept in memory of all inputs for as long as they are read, in bytes.
  [[nodiscard]] virtual std::uint64_t known_bytes() const { return 0; }
  /// Whether inputs may be read in another order than that in which regions() has them.
  [[nodiscard]] virtual bool any_order() const { return false; }
  /// From now on pieces come as planned, with their region. decode() throws
  /// FalseHeader for a point outside of it.
  virtual void keep_to(const RegionOrder& /*order*/) {}
  /// The box that all points just fill in x and y, in the coordinates of decode(), if they fill the
  /// boxes that headers tell of; nothing where something is known to keep them from that.
  [[nodiscard]] virtual std::optional<Box<2>> told_extent() const { return std::nullopt; }
  /// All pieces are to come once more: as planned, or as if there were no plan. False if they
  /// cannot. No piece may be on its way.
  virtual bool read_again(bool /*as_planned*/) { return false; }

  /// Whether another process reads the same points again, and so can go on after some pieces.
  [[nodiscard]] virtual bool goes_on() const { return false; }
  /// Tells where it is between two pieces, none of which is on its way; and goes on from there,
  /// before any piece, but after keep_to().
  virtual void save(StateWriter& /*state*/) {}
  virtual void restore(StateReader& /*state*/) {}

  /// What became of the records so far.
  [[nodiscard]] virtual PointCounts counts() const = 0;
  /// Records read so far, dropped ones among them: counts().read.
  [[nodiscard]] virtual std::uint64_t points_read() const = 0;
  /// How far the points have been read, from 0 to 1; nothing if that is unknown.
  [[nodiscard]] virtual std::optional<double> fraction_read() const = 0;
};

}  // namespace spillway::stream
