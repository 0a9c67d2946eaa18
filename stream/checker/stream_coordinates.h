#pragma once

#include <optional>

#include "formats/meshes/common/mesh_stream.h"
#include "src/geometry/lattice.h"
#include "src/geometry/point.h"
#include "src/geometry/torus.h"

namespace spillway::checker {

/// Between the three kinds of coordinates of a mesh stream: those that its blocks hold, those that
/// predicates run on (the lattice's integers, where the axes have one scale, else output
/// coordinates), and output coordinates.
template <int D>
class StreamCoordinates {
 public:
  /// `input_lattice` serves if the stream has no lattice itself.
  StreamCoordinates(const MeshStreamHeader& header,
                    const std::optional<IntegerLattice>& input_lattice);

  /// The lattice that vertices must lie on, if any.
  [[nodiscard]] const std::optional<IntegerLattice>& lattice() const { return lattice_; }

  /// Of a periodic mesh, the box that it repeats with, where predicates run.
  [[nodiscard]] const std::optional<Torus>& torus() const { return torus_; }

  /// Whether predicates run on integers.
  [[nodiscard]] bool on_lattice() const { return on_lattice_; }

  /// The first axis in which a vertex as it stands in a block is off the lattice, or -1.
  [[nodiscard]] int axis_off_lattice(const LatticePoint& in_block) const;

  /// What predicates run on, of all coordinates of a vertex as they stand in a block; rounded if it
  /// is off the lattice.
  [[nodiscard]] Point<D> for_predicates(Point<D> in_block) const;

  /// Output coordinates of what for_predicates() gave.
  [[nodiscard]] Point<D> to_output(const Point<D>& point) const;

  /// All output coordinates of a vertex as it stands in a block.
  [[nodiscard]] WorldPoint block_to_output(const LatticePoint& in_block) const {
    return blocks_hold_integers_ ? lattice_->to_world(in_block) : WorldPoint(in_block.numbers());
  }

 private:
  std::optional<IntegerLattice> lattice_;
  std::optional<Torus> torus_;
  bool blocks_hold_integers_;
  bool on_lattice_;
};

}  // namespace spillway::checker
