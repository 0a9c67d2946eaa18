#pragma once

#include <spillway/point_counts.h>

#include <bitset>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "formats/points/common/point_reader.h"
#include "src/geometry/box.h"
#include "src/geometry/lattice.h"
#include "stream/source/clip_area.h"
#include "stream/source/condition/condition.h"

namespace spillway::stream {

/// Which returns of a pulse are wanted; any that is named here. A return of unknown number or count
/// passes for first and last.
struct ReturnFilter {
  bool first = false;
  bool last = false;
  bool single = false;        ///< the only return of its pulse
  std::bitset<16> numbers{};  ///< bit n: return n

  bool operator==(const ReturnFilter&) const = default;

  /// Both counted from 1, 0: not known.
  [[nodiscard]] bool keeps(std::uint8_t number, std::uint8_t count_of_pulse) const;
};

/// What is kept of the points that are read, each for itself. In the order of the members; a point
/// is counted where it is dropped first.
struct PointFilter {
  std::uint64_t every = 1;  ///< records 0, n, 2n, ... of each input
  std::optional<std::bitset<256>> classes{};
  std::optional<ReturnFilter> returns{};
  std::optional<Condition> where{};
  std::optional<Box<3>> bounds{};          ///< in output coordinates, closed
  std::shared_ptr<const ClipArea> clip{};  ///< likewise; null: all of the plane

  [[nodiscard]] bool active() const { return every > 1 || needs_attributes() || bounds || clip; }
  [[nodiscard]] bool needs_attributes() const { return classes || returns || where; }
  /// The names of the attributes that it looks at.
  [[nodiscard]] std::vector<std::string> attributes() const;
  /// Around what bounds and clip leave; nothing if that is not bounded.
  [[nodiscard]] std::optional<Box<3>> box() const;
  /// A slightly larger one, for whoever computes coordinates with another lattice than the common
  /// one: it leaves out nothing that may be inside.
  [[nodiscard]] std::optional<Box<3>> loose_box() const;
};

/// Throws Failure: there are no points, or none are left of those that were read.
[[noreturn]] void refuse_empty_input(const PointCounts& counts);

/// Takes out of `block` what the filter drops, and counts it. The points are integers of `lattice`,
/// if there is one, have records of `layout`, and the index is still that of their own input.
void apply_filter(const PointFilter& filter, const std::optional<IntegerLattice>& lattice,
                  const AttributeLayout& layout, PointBlock& block, PointCounts& counts);

}  // namespace spillway::stream
