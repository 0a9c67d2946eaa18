#pragma once

#include <atomic>
#include <cstdint>
#include <optional>

#include "src/geometry/periodic_domain.h"
#include "stream/source/point_stream.h"

namespace spillway::stream {

/// Points brought into a periodic box, and behind those of each block their copies within a margin
/// around it. A copy has the index and the attributes of its point.
class PeriodicPoints final : public PointStream {
 public:
  /// Without a margin, until one is set. `points` must outlive it.
  PeriodicPoints(PointStream& points, const Torus& torus) : points_(points), torus_(torus) {}

  /// Of what is decoded from now on.
  void set_margin(double margin) { domain_.emplace(torus_, margin); }
  /// Forgets what became of points so far: they come again.
  void forget_counts() { wrapped_ = rounded_ = 0; }

  bool fetch(SourcePiece& piece) override { return points_.fetch(piece); }
  void decode(SourcePiece& piece, PointBlock& block) override;

  [[nodiscard]] const std::optional<IntegerLattice>& lattice() const override {
    return points_.lattice();
  }
  /// With copies.
  [[nodiscard]] std::optional<std::uint64_t> expected() const override;
  [[nodiscard]] const std::optional<Box<3>>& extent() const override { return extent_; }
  [[nodiscard]] std::uint64_t known_bytes() const override { return points_.known_bytes(); }

  /// Without copies.
  [[nodiscard]] PointCounts counts() const override;
  [[nodiscard]] std::uint64_t points_read() const override { return points_.points_read(); }
  [[nodiscard]] std::optional<double> fraction_read() const override {
    return points_.fraction_read();
  }

 private:
  void append_copies(PointBlock& block) const;

  PointStream& points_;
  const Torus& torus_;
  std::optional<PeriodicDomain> domain_;
  std::optional<Box<3>> extent_;  ///< is not known
  std::atomic<std::uint64_t> wrapped_ = 0;
  std::atomic<std::uint64_t> rounded_ = 0;
};

}  // namespace spillway::stream
