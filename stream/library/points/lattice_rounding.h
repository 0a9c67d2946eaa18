#pragma once

#include <atomic>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "src/geometry/box.h"
#include "src/geometry/lattice.h"
#include "src/geometry/point.h"

namespace spillway::stream {

/// The lattice that points are to be rounded to.
struct LatticeChoice {
  std::vector<double> scale{};   ///< none, one for all axes, or three
  std::vector<double> offset{};  ///< likewise

  [[nodiscard]] bool empty() const { return scale.empty() && offset.empty(); }
};

/// The lattice of a choice. What it leaves open comes from `source` (the lattice that the points
/// have), if there is one; else the scale is 1e-7 for x and y that can be degrees and 0.001
/// otherwise, and the offset 0 where the points of `extent` are below 2^30 steps from it then, so
/// that there is room in 32 bits for points beyond, otherwise a round number near their centre.
IntegerLattice chosen_lattice(const LatticeChoice& choice,
                              const std::optional<IntegerLattice>& source, const Box<3>& extent);

/// Rounds points to the nearest ones of a lattice, and remembers how far they moved.
class LatticeRounding {
 public:
  /// Points come as integers of `source`, if that is set, else in output coordinates. `output` is
  /// where they go, for messages, and `extent` a box in output coordinates that has some of them,
  /// or none. Throws Failure if `target` does not keep neighbours in it apart.
  LatticeRounding(std::string output, const IntegerLattice& target,
                  const std::optional<IntegerLattice>& source, const Box<3>& extent);

  /// Replaces points by integers of the target lattice. Throws Failure that names the first point
  /// whose integers would take more than 32 bits; `index` has the points' numbers in the input.
  /// Likewise if the target lattice does not keep them apart from their neighbours. Safe for many
  /// threads at a time.
  void round(std::span<LatticePoint> points, std::span<const std::uint64_t> index);

  /// How far a coordinate has moved at most; in output units.
  [[nodiscard]] double farthest() const { return farthest_; }

  [[nodiscard]] const IntegerLattice& target() const { return target_; }

 private:
  void check_target(const Box<3>& integers) const;

  std::string output_;
  IntegerLattice target_;
  std::optional<IntegerLattice> source_;
  std::atomic<double> farthest_ = 0;
};

}  // namespace spillway::stream
