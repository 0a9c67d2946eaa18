#pragma once
// The landscape that the terrain family scans: fractal ground, lakes and a river, villages, woods.
// It is unbounded, a function of the seed, and rasterised to cells of one metre row by row, as the
// scanner moves: a point then costs a look-up, and the noise is shared by all points of a cell.

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "src/generators/noise.h"
#include "src/generators/random.h"

namespace spillway::generators {

/// What lies on top of a cell.
enum class Cover : std::uint8_t { kOpen, kWater, kRoof, kCrown };

/// One square metre; (0, 0) is its corner of smallest coordinates. Metres throughout.
struct ReliefCell {
  float ground = 0;   ///< elevation of the ground at the corner
  float top = 0;      ///< kRoof: elevation at the centre; kCrown: height above the ground
  float slope_x = 0;  ///< kRoof: rise per metre
  float slope_y = 0;
  Cover cover = Cover::kOpen;
};

class Relief {
 public:
  explicit Relief(std::uint64_t seed);

  /// From now on rows consist of `columns` cells from column `first` on, and `rows` successive ones
  /// are kept. Rows must be asked for in about ascending or about descending order to be fast.
  void set_window(std::int64_t first, std::size_t columns, std::size_t rows);

  /// The cells of row y, valid until a row that is further away than the window is asked for.
  const ReliefCell* row(std::int64_t y) {
    const std::size_t slot = static_cast<std::size_t>(y) & slot_mask_;
    if (row_in_slot_[slot] != y) rasterise(y, slot);
    return &cells_[slot * columns_];
  }

 private:
  struct Building {
    std::int64_t x, y, width, depth;
    float eaves, pitch;
  };
  struct Tree {
    float x, y, radius, height;  // x from the window's begin, y from the plantation's row
  };
  /// The trees that reach into one row of a jittered grid. Two grids overlap, so that none is seen.
  struct Plantation {
    std::int64_t spacing;
    std::uint64_t key;
    std::int64_t row = -1;
    std::vector<Tree> trees;
  };

  /// Elevation of the ground, and how far above water it is: 0 in water, 1 on dry land.
  void survey(std::int64_t x, std::int64_t y, std::span<float> ground, std::span<float> dryness);
  [[nodiscard]] float value(const Noise& noise, std::int64_t x, std::int64_t y) const;

  void rasterise(std::int64_t y, std::size_t slot);
  void build(std::int64_t row);
  void plant(Plantation& plantation, std::int64_t row);
  void draw_buildings(std::int64_t y, ReliefCell* cells) const;
  void draw_trees(std::int64_t y, const Plantation& plantation, ReliefCell* cells) const;

  std::uint64_t seed_;
  std::vector<Noise> mountains_, hills_;
  Noise lakes_, shores_, meanders_, bends_, villages_, woods_, glades_;

  std::int64_t building_row_ = -1;
  std::vector<Building> buildings_;
  std::array<Plantation, 2> plantations_;

  std::int64_t first_ = 0;
  std::size_t columns_ = 0;
  std::size_t slot_mask_ = 0;
  std::vector<std::int64_t> row_in_slot_;
  std::vector<ReliefCell> cells_;
  std::vector<float> ground_, dryness_, detail_;
};

}  // namespace spillway::generators
