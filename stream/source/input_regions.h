#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "formats/points/common/point_reader.h"
#include "src/geometry/box.h"
#include "src/geometry/lattice.h"
#include "stream/points/input_region.h"
#include "stream/source/piece_sequence.h"
#include "stream/source/point_filter.h"
#include "stream/source/source_coordinates.h"
#include "stream/source/source_facts.h"

namespace spillway::stream {

/// The box around all points that a header tells; none if it has only zeros in its place, as of a
/// program that has not filled it in.
std::optional<Box<3>> extent_told_by(const PointHeader& header);

/// A box in output coordinates that a header tells, and a step of the header's lattice more: many
/// programs round what they write there.
Box<3> with_a_step_more(const Box<3>& told, const std::optional<IntegerLattice>& lattice);

/// The parts of all inputs of which headers tell where their points lie: those that a header tells
/// of, or a whole file with its extent.
class InputRegions {
 public:
  /// None unless all inputs tell of all of their points.
  InputRegions(const SourceFacts& facts, const SourceCoordinates& coordinates,
               const PointFilter& filter);

  [[nodiscard]] const std::vector<InputRegion>& all() const { return regions_; }
  /// What to read for each unit of all().
  [[nodiscard]] const std::vector<ReadingTurn>& turns() const { return turns_; }
  /// Number in all() of a region of an input.
  [[nodiscard]] std::size_t number(std::size_t input, std::size_t region) const {
    return first_[input] + region;
  }

  /// Throws FalseHeader for the first point outside of its region, given by its number in all().
  /// The points are in the coordinates of the source, their index is still that of their own input.
  void check(const PointBlock& block, std::size_t region) const;

 private:
  [[nodiscard]] Box<3> box_of(std::size_t input, const Box<3>& told) const;
  [[nodiscard]] Box<3> wide_box_of(std::size_t input, const Box<3>& told) const;
  [[noreturn]] void refuse(const PointBlock& block, std::size_t point, std::size_t region) const;

  const SourceFacts& facts_;
  const SourceCoordinates& coordinates_;
  std::vector<InputRegion> regions_;
  std::vector<ReadingTurn> turns_;  ///< by unit
  std::vector<std::size_t> first_;  ///< by input: number of its first region
};

}  // namespace spillway::stream
