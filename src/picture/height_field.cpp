#include "src/picture/height_field.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "src/parallel/parallel.h"

namespace spillway::picture {
namespace {

constexpr std::size_t kRowsAtATime = 8;
constexpr float kNothing = std::numeric_limits<float>::quiet_NaN();
constexpr float kLow = -std::numeric_limits<float>::infinity();

/// Half of the range of slopes towards the light in which a shadow fades out.
constexpr double kSoft = 0.03;
/// Light that stands higher casts no shadow.
constexpr double kSteepestSlope = 100;

}  // namespace

HeightField::HeightField(const HeightPixels& heights, double side, double exaggeration)
    : columns_(heights.columns()),
      rows_(heights.rows()),
      nodes_(std::size_t{heights.columns()} * heights.rows(), kNothing) {
  float lowest = std::numeric_limits<float>::infinity();
  float highest = kLow;
  for (std::size_t i = 0; i < nodes_.size(); ++i) {
    if (heights.samples(i) == 0) continue;
    nodes_[i] = heights.height(i);
    lowest = std::min(lowest, nodes_[i]);
    highest = std::max(highest, nodes_[i]);
  }
  const auto scaled = [&](float height) {
    return static_cast<float>((double{height} - lowest) * exaggeration / side);
  };
  for (float& node : nodes_) node = scaled(node);
  if (highest >= lowest) top_ = scaled(highest);
  find_most();
}

void HeightField::find_most() {
  blocks_across_ = (columns_ + kReach - 1) / kReach;
  const std::uint32_t blocks_down = (rows_ + kReach - 1) / kReach;
  std::vector<float> most(std::size_t{blocks_across_} * blocks_down, kLow);
  for (std::uint32_t row = 0; row < rows_; ++row) {
    for (std::uint32_t column = 0; column < columns_; ++column) {
      const float node = nodes_[std::size_t{row} * columns_ + column];
      float& block = most[std::size_t{row / kReach} * blocks_across_ + column / kReach];
      if (node > block) block = node;
    }
  }
  most_near_.resize(most.size());
  for (std::uint32_t row = 0; row < blocks_down; ++row) {
    for (std::uint32_t column = 0; column < blocks_across_; ++column) {
      float all = kLow;
      for (std::uint32_t r = row > 0 ? row - 1 : 0; r <= std::min(row + 1, blocks_down - 1); ++r) {
        for (std::uint32_t c = column > 0 ? column - 1 : 0;
             c <= std::min(column + 1, blocks_across_ - 1); ++c) {
          all = std::max(all, most[std::size_t{r} * blocks_across_ + c]);
        }
      }
      most_near_[std::size_t{row} * blocks_across_ + column] = all;
    }
  }
}

double HeightField::height(double column, double row) const {
  if (!(column >= 0 && row >= 0 && column <= columns_ - 1 && row <= rows_ - 1)) return kNothing;
  const std::uint32_t c = std::min(static_cast<std::uint32_t>(column), columns_ - 1);
  const std::uint32_t r = std::min(static_cast<std::uint32_t>(row), rows_ - 1);
  // On the last column or row the next one counts for nothing.
  const std::size_t east = c + 1 < columns_ ? 1 : 0;
  const std::size_t south = r + 1 < rows_ ? columns_ : 0;
  const float* const node = &nodes_[std::size_t{r} * columns_ + c];
  const double x = column - c;
  const double y = row - r;
  const double above = node[0] + (double{node[east]} - node[0]) * x;
  const double below = node[south] + (double{node[south + east]} - node[south]) * x;
  return above + (below - above) * y;
}

double HeightField::most_near(double column, double row) const {
  const auto block = [](double place, std::uint32_t count) {
    return static_cast<std::size_t>(std::clamp(place, 0.0, count - 1.0)) / kReach;
  };
  return most_near_[block(row, rows_) * blocks_across_ + block(column, columns_)];
}

std::vector<std::uint8_t> cast_shadows(const HeightField& field, const Light& light) {
  std::vector<std::uint8_t> shadows(std::size_t{field.columns()} * field.rows());
  const double azimuth = light.azimuth * std::numbers::pi / 180;
  const double slope = std::tan(light.altitude * std::numbers::pi / 180);
  if (!(slope < kSteepestSlope)) return shadows;
  // Along an edge of the field light must not leave it by a rounding.
  const auto without_rounding = [](double part) { return std::abs(part) < 1e-12 ? 0.0 : part; };
  const double east = without_rounding(std::sin(azimuth));
  const double south = without_rounding(-std::cos(azimuth));
  const auto shadow_at = [&](std::uint32_t column, std::uint32_t row, double node) {
    // The steepest way up to what stands in the direction of the light.
    double steepest = slope - kSoft;
    for (double way = 1; node + way * steepest <= field.top(); way += 1) {
      const double c = column + way * east;
      const double r = row + way * south;
      if (!(c >= 0 && r >= 0 && c <= field.columns() - 1 && r <= field.rows() - 1)) break;
      if (node + way * steepest > field.most_near(c, r)) {
        way += HeightField::kReach - 1;
        continue;
      }
      const double up = (field.height(c, r) - node) / way;
      if (up > steepest) steepest = up;
    }
    return std::clamp((steepest - slope + kSoft) / (2 * kSoft), 0.0, 1.0);
  };
  parallel_for(field.rows(), kRowsAtATime, [&](std::size_t, std::size_t begin, std::size_t end) {
    for (auto row = static_cast<std::uint32_t>(begin); row < end; ++row) {
      for (std::uint32_t column = 0; column < field.columns(); ++column) {
        const std::size_t pixel = std::size_t{row} * field.columns() + column;
        const float node = field.node(pixel);
        if (std::isnan(node)) continue;
        shadows[pixel] = static_cast<std::uint8_t>(std::lround(shadow_at(column, row, node) * 255));
      }
    }
  });
  return shadows;
}

}  // namespace spillway::picture
