#pragma once

#include <spillway/export.h>

#include <bitset>
#include <cstdint>
#include <string>

namespace spillway {

/// What became of the points of a source. A point is counted where it is dropped first.
struct PointCounts {
  std::uint64_t read = 0;      ///< records
  std::uint64_t invalid = 0;   ///< dropped by PointOptions::skip_invalid
  std::uint64_t withheld = 0;  ///< dropped since flagged so
  std::uint64_t skipped = 0;   ///< by PointOptions::every
  std::uint64_t classes = 0;   ///< of other classes
  std::uint64_t returns = 0;   ///< of other returns
  std::uint64_t bounds = 0;    ///< outside of the bounds
  std::uint64_t clip = 0;      ///< where PointOptions::clip keeps none
  std::uint64_t thinned = 0;   ///< another one stands for their cell
  /// Not read, though the files should hold them: what PointOptions::salvage could not save.
  std::uint64_t lost = 0;
  std::uint64_t where = 0;    ///< dropped, as PointOptions::where does not hold
  std::uint64_t wrapped = 0;  ///< kept, and brought into the periodic box from outside
  std::uint64_t rounded = 0;  ///< kept, and rounded to where copies are exact (PeriodicBox)
  /// Bit n: points of class n are among those that `classes` counts.
  std::bitset<256> other_classes{};

  PointCounts& operator+=(const PointCounts& other) {
    read += other.read;
    invalid += other.invalid;
    withheld += other.withheld;
    skipped += other.skipped;
    classes += other.classes;
    returns += other.returns;
    bounds += other.bounds;
    clip += other.clip;
    thinned += other.thinned;
    lost += other.lost;
    where += other.where;
    wrapped += other.wrapped;
    rounded += other.rounded;
    other_classes |= other.other_classes;
    return *this;
  }
  bool operator==(const PointCounts&) const = default;

  [[nodiscard]] std::uint64_t dropped() const {
    return invalid + withheld + skipped + classes + returns + where + bounds + clip + thinned;
  }
  /// Whether every point of the files is used.
  [[nodiscard]] bool all_kept() const { return dropped() == 0 && lost == 0; }
  [[nodiscard]] std::uint64_t kept() const { return read - dropped(); }
};

/// One line: "500 points read, 12 withheld, 300 outside the bounds, 188 kept". Where none are kept,
/// it names other classes: "500 points read, 500 of other classes (1, 3-5), 0 kept". Lost points
/// are told of, too: "480 points read (20 are lost), 480 kept".
SPILLWAY_API std::string describe(const PointCounts& counts);

}  // namespace spillway
