#pragma once

#include <optional>
#include <span>
#include <vector>

#include "src/geometry/lattice.h"
#include "stream/ground/waiting_points.h"
#include "stream/sinks/simplex_sink.h"

namespace spillway::stream {

/// Brings a mesh of triangles to the points above it, as its blocks come.
class GroundWriter final : public SimplexSink<PlacedPoint> {
 public:
  /// `lattice` is that of the vertices to come; triangles are there in x and y, too. `points` must
  /// outlive it.
  GroundWriter(const std::optional<IntegerLattice>& lattice, WaitingPoints& points)
      : SimplexSink(2), lattice_(lattice), points_(points) {}

 private:
  [[nodiscard]] std::vector<PlacedPoint> values_of(
      std::span<const LatticePoint> vertices) const override {
    std::vector<PlacedPoint> placed;
    placed.reserve(vertices.size());
    for (const LatticePoint& vertex : vertices) {
      const double z = lattice_ ? lattice_->to_world(2, vertex[2]) : vertex[2];
      placed.emplace_back(vertex[0], vertex[1], z);
    }
    return placed;
  }
  void take_vertices(std::span<const PlacedPoint> /*vertices*/) override {}
  void take_simplices(std::span<const PlacedPoint> vertices,
                      std::span<const std::uint32_t> corners) override {
    points_.add(vertices, corners);
  }

  const std::optional<IntegerLattice> lattice_;
  WaitingPoints& points_;
};

}  // namespace spillway::stream
