#pragma once
// What the scan family sees: a few streets of houses on uneven ground, and the places where the
// scanner stands. Metres throughout; all coordinates of the scene are positive.

#include <cstddef>
#include <cstdint>
#include <vector>

#include "src/generators/direction.h"
#include "src/geometry/point.h"

namespace spillway::generators {

/// How far a scanner sees.
constexpr double kScanRange = 120;

/// Ground that rises and falls by a metre or two, bilinear within squares of one metre.
class ScanGround {
 public:
  explicit ScanGround(std::uint64_t seed);

  /// The elevation at a place that is in the range of a station.
  [[nodiscard]] double height(double x, double y) const;

 private:
  std::vector<float> heights_;  // at the corners, row by row
};

/// A rectangle with walls up to its roof, which falls to both sides of a ridge along the middle. A
/// flat roof is one that does not fall.
struct ScanBuilding {
  double x, y;      ///< of its middle
  Direction along;  ///< of its ridge
  double half_length, half_width;
  double ridge;  ///< elevation
  double pitch;  ///< metres that the roof falls a metre across the ridge
};

/// A function of the seed. No two buildings meet, and none is within 6 metres of a station.
struct ScanScene {
  explicit ScanScene(std::uint64_t seed);

  ScanGround ground;
  std::vector<ScanBuilding> buildings;  ///< 10 to 20
  std::vector<Point<3>> stations;       ///< 3 to 6: the scanner's mirror, 1.7 metres above ground
};

}  // namespace spillway::generators
