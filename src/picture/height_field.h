#pragma once

#include <cstdint>
#include <vector>

#include "src/picture/relief.h"
#include "src/terrain/pixel_values.h"

namespace spillway::picture {

/// Heights of a picture's pixels as a surface that rays meet: bilinear between the pixels' centres,
/// which are its nodes, a unit apart. Columns run east, rows south.
class HeightField {
 public:
  /// `side` is the length of a pixel's side in units of heights, which are exaggerated.
  HeightField(const HeightPixels& heights, double side, double exaggeration);

  [[nodiscard]] std::uint32_t columns() const { return columns_; }
  [[nodiscard]] std::uint32_t rows() const { return rows_; }
  /// Of the highest node above the lowest one.
  [[nodiscard]] double top() const { return top_; }
  /// Above the lowest node; not a number where there is no height.
  [[nodiscard]] float node(std::size_t pixel) const { return nodes_[pixel]; }
  /// Likewise anywhere; not a number unless all four nodes around have a height.
  [[nodiscard]] double height(double column, double row) const;

  /// No height within kReach of a place is above this.
  [[nodiscard]] double most_near(double column, double row) const;
  static constexpr std::uint32_t kReach = 8;

 private:
  void find_most();

  std::uint32_t columns_;
  std::uint32_t rows_;
  double top_ = 0;
  std::vector<float> nodes_;
  std::uint32_t blocks_across_ = 0;  ///< blocks of kReach x kReach nodes
  std::vector<float> most_near_;     ///< of each block and those around it
};

/// How much of the light each pixel does not get because something stands in between: 0 to 255. The
/// light is a little wide, so that shadows have soft edges.
std::vector<std::uint8_t> cast_shadows(const HeightField& field, const Light& light);

}  // namespace spillway::picture
