#pragma once
// Which pixel centres lie in a triangle: decided by signs of exact determinants, so that triangles
// which share an edge neither leave a pixel out nor disagree about it. docs/dem.md tells how.

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include "src/geometry/point.h"
#include "src/terrain/pixel_centres.h"

namespace spillway::terrain {

/// A triangle with heights; x and y in the coordinates of the pixel centres.
using Triangle = std::array<Point<3>, 3>;

/// The corners in lexicographic order: what is computed from them depends on nothing else.
Triangle in_canonical_order(const Triangle& triangle);

/// Where in a triangle a centre lies, its corners being in canonical order.
enum class PixelRelation : std::uint8_t {
  kInside,
  kEdge01,
  kEdge02,
  kEdge12,
  kCorner0,
  kCorner1,
  kCorner2,
};

/// Pixels of one row, from `begin` to before `end`.
struct PixelRun {
  std::uint32_t row = 0;
  std::uint32_t begin = 0;
  std::uint32_t end = 0;
  PixelRelation relation = PixelRelation::kInside;
  /// Whether the triangle owns these pixels. A centre inside a triangulation, on a common edge or
  /// vertex too, has exactly one owner: the triangle that it lies in when moved east by nearly
  /// nothing, and north by nearly nothing of that. One on the hull may have none.
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
