#pragma once

#include <span>
#include <vector>

#include "formats/state/state_reader.h"
#include "formats/state/state_writer.h"
#include "stream/sinks/dem.h"
#include "stream/sinks/simplex_sink.h"

namespace spillway::stream {

/// Paints a mesh of triangles as its blocks come, into a Dem that all threads share.
class DemWriter final : public SimplexSink<PlacedPoint> {
 public:
  /// `dem` must outlive it, and must have begun before the first block comes.
  explicit DemWriter(Dem& dem) : SimplexSink(2), dem_(dem) {}

  void save(StateWriter& state) override {
    this->state(state);
    dem_.save(state);
  }
  void restore(StateReader& state) override {
    this->state(state);
    dem_.restore(state);
  }

 private:
  [[nodiscard]] std::vector<PlacedPoint> values_of(
      std::span<const LatticePoint> vertices) const override {
    return dem_.placed(vertices);
  }
  void take_vertices(std::span<const PlacedPoint> vertices) override { dem_.count(vertices); }
  void take_simplices(std::span<const PlacedPoint> vertices,
                      std::span<const std::uint32_t> corners) override {
    dem_.paint(vertices, corners);
  }

  Dem& dem_;
};

}  // namespace spillway::stream
