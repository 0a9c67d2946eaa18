#pragma once

#include <cstdint>
#include <optional>

#include "stream/periodic/periodic_copies.h"
#include "stream/source/point_stream.h"

namespace spillway::stream {

/// Points as PeriodicCopies make them.
class PeriodicPoints final : public PointStream {
 public:
  /// Both must outlive it.
  PeriodicPoints(PointStream& points, PeriodicCopies& copies) : points_(points), copies_(copies) {}

  bool fetch(SourcePiece& piece) override { return points_.fetch(piece); }
  void decode(SourcePiece& piece, PointBlock& block) override {
    points_.decode(piece, block);
    copies_.apply(block);
  }

  [[nodiscard]] const std::optional<IntegerLattice>& lattice() const override {
    return points_.lattice();
  }
  /// With copies.
  [[nodiscard]] std::optional<std::uint64_t> expected() const override {
    const std::optional<std::uint64_t> points = points_.expected();
    return points ? std::optional(copies_.with_copies(*points)) : points;
  }
  [[nodiscard]] const std::optional<Box<3>>& extent() const override { return extent_; }
  [[nodiscard]] std::uint64_t known_bytes() const override { return points_.known_bytes(); }

  /// Without copies.
  [[nodiscard]] PointCounts counts() const override {
    PointCounts counts = points_.counts();
    counts.wrapped = copies_.wrapped();
    counts.rounded = copies_.rounded();
    return counts;
  }
  [[nodiscard]] std::uint64_t points_read() const override { return points_.points_read(); }
  [[nodiscard]] std::optional<double> fraction_read() const override {
    return points_.fraction_read();
  }

 private:
  PointStream& points_;
  PeriodicCopies& copies_;
  const std::optional<Box<3>> extent_;  ///< is not known
};

}  // namespace spillway::stream
