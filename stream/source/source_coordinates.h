#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <string_view>
#include <vector>

#include "formats/points/common/point_reader.h"
#include "src/geometry/box.h"
#include "src/geometry/lattice.h"
#include "stream/source/common_lattice.h"
#include "stream/source/point_filter.h"
#include "stream/source/source_facts.h"

namespace spillway::stream {

/// The coordinates in which the points of all inputs come: integers of one lattice where all inputs
/// lie on one, else output coordinates.
class SourceCoordinates {
 public:
  /// Finds them; `filter` says which points are used. `facts` must outlive the coordinates;
  /// `detail` receives which ones they are, and why. Throws Failure if the lattice of an input does
  /// not keep its points apart, by what its header says of them.
  SourceCoordinates(const SourceFacts& facts, int dimension, const PointFilter& filter,
                    const std::function<void(std::string_view)>& detail);

  /// The lattice of all inputs (find_common_lattice); nothing: output coordinates.
  [[nodiscard]] const std::optional<IntegerLattice>& lattice() const { return lattice_; }
  /// Whether z is on lattice(), too: an integer, and not an output coordinate.
  [[nodiscard]] bool heights_on_lattice() const { return heights_on_lattice_; }

  /// Of x, y and z those that are triangulated.
  [[nodiscard]] int dimension() const { return dimension_; }

  /// A box of output coordinates in these coordinates.
  [[nodiscard]] Box<3> of_world(const Box<3>& world) const;

  /// What the header of an input tells of its extent, in these coordinates, such as points at its
  /// edges have them: what rounding has done to the header is undone.
  [[nodiscard]] Box<3> told_extent(std::size_t input) const;
  /// The same for another box that the input's header tells.
  [[nodiscard]] Box<3> told_box(std::size_t input, const Box<3>& world) const;

  /// Brings the points of a block, which are as the reader of an input gives them, into these
  /// coordinates. Throws Failure if lattices do not keep those apart that the filter keeps. Safe for
  /// many threads at a time.
  void bring(std::size_t input, const AttributeLayout& attributes, PointBlock& block) const;

 private:
  struct Input {
    LatticeMap map;         ///< from its integers to those of lattice_
    bool as_it_is = false;  ///< its coordinates are these
    /// Integers above this one may not be apart in output coordinates: blocks that have such are
    /// looked at more closely. Nothing if it does not give any.
    std::optional<double> exact_up_to;
  };

  [[nodiscard]] const PointHeader& header_of(std::size_t input) const {
    return facts_.inputs[input].header;
  }
  void check_own_lattices();
  void find_lattice(const std::function<void(std::string_view)>& detail);
  [[nodiscard]] std::optional<CommonLattice> common_lattice() const;
  [[nodiscard]] const PointHeader* first_not_apart(const CommonLattice& common) const;
  void explain_lattice(const std::function<void(std::string_view)>& detail) const;
  void check_points(std::size_t input, const AttributeLayout& attributes, PointBlock block) const;
  [[nodiscard]] LatticePoint placed(std::size_t input, const LatticePoint& point) const;

  const SourceFacts& facts_;
  /// Axes that are to have one scale.
  [[nodiscard]] int joined_axes() const { return is_triangulated_ ? dimension_ : 0; }

  bool is_triangulated_;
  bool is_on_lattice_;
  int dimension_;
  PointFilter filter_;  ///< its bounds are loose
  std::vector<Input> inputs_;
  std::optional<IntegerLattice> lattice_;
  bool heights_on_lattice_ = false;
};

}  // namespace spillway::stream
