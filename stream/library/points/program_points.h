#pragma once

#include <spillway/points.h>

#include <atomic>
#include <cstdint>
#include <optional>
#include <vector>

#include "stream/library/points/engine_points.h"
#include "stream/source/point_stream.h"

namespace spillway::stream {

/// The points of a program's own source, as the pipeline takes them.
class ProgramPoints final : public PointStream, public EnginePoints {
 public:
  /// `source` must outlive it. Of its lattice only one is used on which that many axes are alike,
  /// or any if `dimension` is 0. Throws Failure(kInvalidArgument) for a header that cannot be.
  explicit ProgramPoints(PointSource& source, int dimension = 0);

  bool fetch(SourcePiece& piece) override;
  void decode(SourcePiece& piece, PointBlock& block) override;

  [[nodiscard]] const std::optional<IntegerLattice>& lattice() const override { return lattice_; }
  [[nodiscard]] std::optional<std::uint64_t> expected() const override { return header_.count; }
  [[nodiscard]] const std::optional<Box<3>>& extent() const override { return extent_; }
  [[nodiscard]] PointCounts counts() const override { return {.read = read_}; }
  [[nodiscard]] std::uint64_t points_read() const override { return read_; }
  [[nodiscard]] std::optional<double> fraction_read() const override;

  void settle_crs(CrsNeed need) override;
  RunPoints begin(RunWatch& watch, bool index) override;

 private:
  void check_coordinate(int axis) const;
  [[nodiscard]] LatticePoint placed(const spillway::Point<3>& point, std::uint64_t number) const;

  PointSource& source_;
  PointsHeader header_;
  AttributeLayout told_;         ///< that each block of the program has
  AttributeLayout attributes_;   ///< those of them that are wanted
  spillway::PointsBlock block_;  ///< that was read last
  int dimension_;                ///< in which they are triangulated; 0: they are not
  std::optional<IntegerLattice> lattice_;
  bool heights_on_lattice_ = false;
  std::optional<Box<3>> world_extent_;
  std::optional<Box<3>> extent_;
  std::atomic<std::uint64_t> read_ = 0;
};

}  // namespace spillway::stream
