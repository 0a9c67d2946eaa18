#pragma once

#include <spillway/generate.h>

#include <atomic>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "src/generators/generators.h"
#include "stream/library/points/engine_points.h"
#include "stream/source/point_stream.h"

namespace spillway::stream {

/// Points that are made while they are read, in blocks of 65,536.
class GeneratedPoints final : public PointSource, public EnginePoints, private PointStream {
 public:
  /// Throws Failure(kInvalidArgument) for options that cannot be.
  explicit GeneratedPoints(const GenerateOptions& options);

  [[nodiscard]] PointsHeader header() const override;
  bool read(std::vector<spillway::Point<3>>& points) override;
  bool read(spillway::PointsBlock& block) override;

  RunPoints begin(RunWatch& watch, bool index) override;
  [[nodiscard]] const char* phase() const override { return "generate"; }

 private:
  EnginePoints* engine_points() override { return this; }

  bool fetch(SourcePiece& piece) override;
  void decode(SourcePiece& piece, PointBlock& block) override;
  [[nodiscard]] const std::optional<IntegerLattice>& lattice() const override { return lattice_; }
  [[nodiscard]] std::optional<std::uint64_t> expected() const override { return count_; }
  [[nodiscard]] const std::optional<Box<3>>& extent() const override { return extent_; }
  [[nodiscard]] PointCounts counts() const override { return {.read = made_}; }
  [[nodiscard]] std::uint64_t points_read() const override { return made_; }
  [[nodiscard]] std::optional<double> fraction_read() const override;

  std::uint64_t make(std::vector<LatticePoint>& points, std::vector<std::byte>& records);

  bool is_taken_ = false;  ///< by a run
  std::uint64_t count_;
  int dimension_;
  bool has_heights_;
  AttributeLayout attributes_;  ///< coordinates beyond z
  std::unique_ptr<PointGenerator> generator_;
  std::vector<Point<3>> numbers_;  ///< of the points that were made last
  std::optional<IntegerLattice> lattice_;
  std::optional<Box<3>> extent_;  ///< not known
  std::atomic<std::uint64_t> made_ = 0;
};

}  // namespace spillway::stream
