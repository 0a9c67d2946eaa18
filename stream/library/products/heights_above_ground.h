#pragma once

#include <spillway/height.h>

#include <atomic>
#include <cstdint>
#include <mutex>
#include <optional>
#include <vector>

#include "formats/points/attributes/attribute_layout.h"
#include "formats/points/attributes/record_selection.h"
#include "stream/ground/ground_heights.h"
#include "stream/ground/repeated_points.h"
#include "stream/library/points/engine_points.h"
#include "stream/source/point_stream.h"

namespace spillway::stream {

/// Points with their heights above the ground, as an attribute or in place of z, in their order.
class HeightsAboveGround final : public PointStream {
 public:
  /// `points` is what `repeated` repeats, which must have begun to. Both and `ground` must outlive
  /// it.
  HeightsAboveGround(const RunPoints& points, RepeatedPoints& repeated, const GroundHeights& ground,
                     const HeightOptions& options);

  /// As they are written.
  [[nodiscard]] RunPoints run();

  bool fetch(SourcePiece& piece) override { return repeated_.fetch(piece); }
  void decode(SourcePiece& piece, PointBlock& block) override;

  [[nodiscard]] const std::optional<IntegerLattice>& lattice() const override { return lattice_; }
  [[nodiscard]] std::optional<std::uint64_t> expected() const override {
    return repeated_.expected();
  }
  [[nodiscard]] const std::optional<Box<3>>& extent() const override { return extent_; }
  [[nodiscard]] PointCounts counts() const override { return repeated_.counts(); }
  [[nodiscard]] std::uint64_t points_read() const override { return repeated_.points_read(); }
  [[nodiscard]] std::optional<double> fraction_read() const override {
    return repeated_.fraction_read();
  }

  /// What became of the points that have come: all of HeightReport that is about heights.
  [[nodiscard]] HeightReport report() const;

 private:
  [[nodiscard]] double rounded(double height) const;
  [[nodiscard]] bool is_wanted(double height) const;
  void count(const std::vector<double>& heights, std::size_t kept);
  void put_attribute(PointBlock& block, const std::vector<double>& heights) const;
  void replace_z(PointBlock& block, const std::vector<double>& heights) const;

  const RunPoints& points_;
  RepeatedPoints& repeated_;
  const GroundHeights& ground_;
  const HeightOptions& options_;
  std::optional<double> unit_;  ///< of z, if it is on a lattice
  std::optional<IntegerLattice> lattice_;
  std::optional<Box<3>> extent_;
  RecordSelection others_;  ///< attributes but one of that name
  std::size_t others_size_ = 0;
  AttributeLayout attributes_;
  mutable std::mutex mutex_;  ///< guards the next one
  HeightReport counted_;
};

}  // namespace spillway::stream
