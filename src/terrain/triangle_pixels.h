#pragma once
// Which pixel centres lie in a triangle: decided by signs of exact determinants, so that triangles
// which share an edge neither leave a pixel out nor disagree about it. docs/dem.md tells how.

#include <algorithm>
#include <cstdint>
#include <vector>

#include "src/geometry/point.h"
#include "src/terrain/pixel_centres.h"
#include "src/terrain/triangle_location.h"

namespace spillway::terrain {

/// Pixels of one row, from `begin` to before `end`.
struct PixelRun {
  std::uint32_t row = 0;
  std::uint32_t begin = 0;
  std::uint32_t end = 0;
  TriangleRelation relation = TriangleRelation::kInside;
  /// Whether the triangle owns these pixels (TriangleLocation).
  bool owned = true;
};

/// Some rows and columns of a raster.
struct PixelWindow {
  std::uint32_t row_begin = 0;
  std::uint32_t row_end = 0;
  std::uint32_t column_begin = 0;
  std::uint32_t column_end = 0;

  [[nodiscard]] bool empty() const { return row_begin >= row_end || column_begin >= column_end; }
};

/// Where a point lies among the centres: the first column not west of it and the first east of it,
/// the first row not north of it and the first south of it.
struct CentreWindow {
  std::uint32_t column_begin = 0;
  std::uint32_t column_end = 0;
  std::uint32_t row_begin = 0;
  std::uint32_t row_end = 0;
};

CentreWindow centres_around(const PixelCentres& centres, const Point<3>& vertex);

/// The window of all centres in the closed box around three vertices. Most triangles of a fine mesh
/// have none, so this is what has to be quick.
inline PixelWindow window_of(const CentreWindow& a, const CentreWindow& b, const CentreWindow& c) {
  return {std::min({a.row_begin, b.row_begin, c.row_begin}),
          std::max({a.row_end, b.row_end, c.row_end}),
          std::min({a.column_begin, b.column_begin, c.column_begin}),
          std::max({a.column_end, b.column_end, c.column_end})};
}

/// Replaces `runs` by all pixels of the window whose centres lie in the closed triangle. A triangle
/// without area has none, for its neighbours have them.
void find_pixels(const PixelCentres& centres, const Triangle& canonical, const PixelWindow& window,
                 std::vector<PixelRun>& runs);

}  // namespace spillway::terrain
