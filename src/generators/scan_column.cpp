#include "src/generators/scan_column.h"

#include <algorithm>
#include <limits>

namespace spillway::generators {

void ScanColumn::aim(const Point<3>& station, const Direction& azimuth) {
  for (std::size_t i = 0; i <= kSteps; ++i) {
    const double distance = kStep * static_cast<double>(i);
    ground_[i] = scene_->ground.height(station[0] + distance * azimuth.cosine,
                                       station[1] + distance * azimuth.sine) -
                 station[2];
  }
  cuts_.clear();
  highest_slope_ = -std::numeric_limits<double>::infinity();
  for (const ScanBuilding& building : scene_->buildings) {
    if (const auto cut = cut_of(building, station, azimuth)) {
      cuts_.push_back(*cut);
      const double top = building.ridge - station[2];
      highest_slope_ = std::max(highest_slope_, top / (top > 0 ? cut->enter : cut->leave));
    }
  }
  std::sort(cuts_.begin(), cuts_.end(),
            [](const Cut& a, const Cut& b) { return a.enter < b.enter; });
  ground_step_ = 0;
}

std::optional<ScanColumn::Cut> ScanColumn::cut_of(const ScanBuilding& building,
                                                  const Point<3>& station,
                                                  const Direction& azimuth) {
  const Direction& along = building.along;
  const double dx = station[0] - building.x;
  const double dy = station[1] - building.y;
  // Along the ridge and across it: where the station is, where the column goes, where walls are.
  const std::array<double, 2> from = {dx * along.cosine + dy * along.sine,
                                      dy * along.cosine - dx * along.sine};
  const std::array<double, 2> towards = {azimuth.cosine * along.cosine + azimuth.sine * along.sine,
                                         azimuth.sine * along.cosine - azimuth.cosine * along.sine};
  const std::array<double, 2> half = {building.half_length, building.half_width};
  double enter = 0;
  double leave = kScanRange;
  for (int k = 0; k < 2; ++k) {
    // For a column that runs along a wall these are infinite, of one sign beside the building.
    const double first = (-half[k] - from[k]) / towards[k];
    const double second = (half[k] - from[k]) / towards[k];
    enter = std::max(enter, std::min(first, second));
    leave = std::min(leave, std::max(first, second));
  }
  if (enter >= leave) return std::nullopt;
  const double ridge = building.ridge - station[2];
  const double at = building.pitch * from[1];
  const double rise = building.pitch * towards[1];
  return Cut{enter, leave, {{{ridge - at, -rise}, {ridge + at, rise}}}};
}

std::optional<double> ScanColumn::hit_of(const Cut& cut, double slope) {
  double enter = cut.enter;
  double leave = cut.leave;
  for (const RoofLine& line : cut.roof) {
    const double rise = slope - line.rise;
    const double distance = line.at / rise;
    if (rise < 0) {
      enter = std::max(enter, distance);
    } else if (rise > 0) {
      leave = std::min(leave, distance);
    } else if (line.at < 0) {
      return std::nullopt;
    }
  }
  if (enter > leave) return std::nullopt;
  return enter;
}

std::optional<double> ScanColumn::ground_hit() {
  const auto distance = [](std::size_t step) { return kStep * static_cast<double>(step); };
  while (ground_step_ < kSteps && slope_ * distance(ground_step_ + 1) > ground_[ground_step_ + 1]) {
    ++ground_step_;
  }
  if (ground_step_ == kSteps) return std::nullopt;
  const double here = ground_[ground_step_];
  const double rise = (ground_[ground_step_ + 1] - here) / kStep;
  return (here - rise * distance(ground_step_)) / (slope_ - rise);
}

std::optional<double> ScanColumn::first_hit(const Direction& elevation) {
  slope_ = elevation.sine / elevation.cosine;
  std::optional<double> hit = ground_hit();
  for (const Cut& cut : cuts_) {
    if (hit && *hit < cut.enter) break;
    if (const auto of_building = hit_of(cut, slope_)) {
      if (!hit || *of_building < *hit) hit = of_building;
      break;
    }
  }
  if (!hit || *hit > kScanRange * elevation.cosine) return std::nullopt;
  return *hit / elevation.cosine;
}

}  // namespace spillway::generators
