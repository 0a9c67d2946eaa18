#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <vector>

#include "src/generators/scan_scene.h"

namespace spillway::generators {

/// What a scanner sees while its mirror swings up once: the half plane that a column of rays lies
/// in, with the ground and the buildings that it cuts. There a ray is a line of one slope. Rays
/// must come in the order in which they rise: the ground that the last one has passed is not looked
/// at again, so a ray costs a few operations for each building in its way.
class ScanColumn {
 public:
  /// The scene must stay.
  explicit ScanColumn(const ScanScene& scene) : scene_(&scene) {}

  /// Turns to a column of a station.
  void aim(const Point<3>& station, const Direction& azimuth);

  /// The distance, along the next ray, of the first surface; none if there is none in the range.
  /// The ray rises by elevation.sine while it goes elevation.cosine > 0.
  std::optional<double> first_hit(const Direction& elevation);

  /// No ray that is higher than the last one hits anything.
  [[nodiscard]] bool is_done() const { return ground_step_ == kSteps && slope_ > highest_slope_; }

 private:
  static constexpr double kStep = 0.5;  ///< metres; half the side of the ground's squares
  static constexpr std::size_t kSteps = static_cast<std::size_t>(kScanRange / kStep);

  /// One half of a roof, by its height over the station's: at + rise * distance.
  struct RoofLine {
    double at, rise;
  };

  /// A building between the distances of its walls. It is all that is below both lines.
  struct Cut {
    double enter, leave;
    std::array<RoofLine, 2> roof;
  };

  [[nodiscard]] static std::optional<Cut> cut_of(const ScanBuilding& building,
                                                 const Point<3>& station, const Direction& azimuth);
  [[nodiscard]] static std::optional<double> hit_of(const Cut& cut, double slope);
  std::optional<double> ground_hit();

  const ScanScene* scene_;
  std::array<double, kSteps + 1> ground_{};  // over the station's height, from there on
  std::vector<Cut> cuts_;                    // from near to far
  double highest_slope_ = 0;                 // of rays that may hit a building
  double slope_ = 0;                         // of the last ray
  std::size_t ground_step_ = 0;              // up to which it is above the ground
};

}  // namespace spillway::generators
