#pragma once

#include <spillway/points.h>

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "formats/points/attributes/further_coordinates.h"
#include "stream/library/points/engine_points.h"
#include "stream/source/point_stream.h"

namespace spillway::stream {

/// Points of an array in memory; a run's threads take them from there. Coordinates beyond z come as
/// attributes.
template <int D>
class MemoryPoints final : public PointSource, public EnginePoints, private PointStream {
 public:
  /// What the view refers to must outlive it.
  MemoryPoints(PointView<D> points, AttributeColumns attributes)
      : points_(points), offered_(std::move(attributes)) {
    check();
  }
  MemoryPoints(std::vector<spillway::Point<D>> points, AttributeColumns attributes)
      : kept_(std::move(points)), points_(kept_), offered_(std::move(attributes)) {
    check();
  }

  [[nodiscard]] PointsHeader header() const override {
    return {.coordinates = std::min(D, kOwnAxes),
            .count = points_.size(),
            .attributes = all_attributes().attributes()};
  }
  bool read(std::vector<spillway::Point<3>>& points) override;
  bool read(spillway::PointsBlock& block) override;

  RunPoints begin(RunWatch& watch, bool index) override;

 private:
  EnginePoints* engine_points() override { return this; }
  bool fetch(SourcePiece& piece) override;
  void decode(SourcePiece& piece, PointBlock& block) override;
  [[nodiscard]] const std::optional<IntegerLattice>& lattice() const override { return lattice_; }
  [[nodiscard]] std::optional<std::uint64_t> expected() const override { return points_.size(); }
  [[nodiscard]] const std::optional<Box<3>>& extent() const override { return extent_; }
  [[nodiscard]] PointCounts counts() const override { return {.read = next_}; }
  [[nodiscard]] std::uint64_t points_read() const override { return next_; }
  [[nodiscard]] std::optional<double> fraction_read() const override;

  void check() const;
  /// What points have besides x, y and z: their coordinates beyond these, and what was given.
  [[nodiscard]] AttributeLayout all_attributes() const;
  [[nodiscard]] spillway::Point<3> point(std::uint64_t number) const;
  [[nodiscard]] std::vector<std::byte> records(const AttributeLayout& layout, std::uint64_t first,
                                               std::uint64_t count) const;

  std::vector<spillway::Point<D>> kept_;  ///< or none
  PointView<D> points_;
  AttributeColumns offered_;
  AttributeLayout attributes_;           ///< those of them that a run wants
  bool is_taken_ = false;                ///< by a run
  std::atomic<std::uint64_t> next_ = 0;  ///< that is to be read
  const std::optional<IntegerLattice> lattice_;
  const std::optional<Box<3>> extent_;  ///< not known
};

}  // namespace spillway::stream
