#pragma once
// What the heights of a pixel and its eight neighbours tell of the terrain, as gdaldem tells it.

#include <spillway/choices.h>

#include <array>
#include <cmath>

#include "src/geometry/framed_point.h"
#include "src/terrain/pixel_values.h"

namespace spillway::terrain {

/// Heights of a pixel, the fifth, and of its neighbours, row by row from the north-west. Not a
/// number where there is none.
using Neighbourhood = std::array<float, 9>;

/// Whether all nine are finite.
inline bool is_complete(const Neighbourhood& z) {
  float zero = 0;
  for (const float height : z) zero += height * 0;
  return zero == 0;
}

/// On which sides of a pixel the raster ends.
struct RasterEnd {
  bool north = false;
  bool south = false;
  bool west = false;
  bool east = false;

  [[nodiscard]] bool any() const { return north || south || west || east; }
};

/// Makes up missing heights beyond the raster by going on as from the row or column inside, and
/// gives other missing neighbours the pixel's own height; by the rules of `gdaldem -compute_edges`.
/// Where the raster is one row or column, they stay missing.
void complete(Neighbourhood& z, const RasterEnd& end);

/// The gradient at the pixel. `sides`: its width and height, in the unit of the heights. Sums are
/// rounded to float in the order of gdaldem, so that both find the same ground level. By Horn ("Hill
/// shading and the reflectance map", 1981) or Zevenbergen and Thorne ("Quantitative analysis of land
/// surface topography", 1987).
inline Gradient gradient_of(const Neighbourhood& z, GradientMethod method, const Point<2>& sides) {
  if (method == GradientMethod::kZevenbergenThorne) {
    return {(z[5] - z[3]) / (2 * sides[0]), (z[1] - z[7]) / (2 * sides[1])};
  }
  const float east = (z[2] + z[5] + z[5] + z[8]) - (z[0] + z[3] + z[3] + z[6]);
  const float north = (z[0] + z[1] + z[1] + z[2]) - (z[6] + z[7] + z[7] + z[8]);
  return {east / (8 * sides[0]), north / (8 * sides[1])};
}

/// The direction that the surface falls to, as aspect_of(), but rounded to float in the steps of
/// gdaldem, counter-clockwise from east and then clockwise from north.
float rounded_aspect_of(const Gradient& gradient);

/// Brightness from 1 (no light) to 255 (facing the light): 1 and 254 times the cosine of the angle
/// between the light and the surface's normal.
double shade_of(const Gradient& gradient, const Point<3>& light_direction);

/// The same with light at `altitude` degrees above the horizon from 225, 270, 315 and 360 degrees,
/// each weighted by half the squared cosine of the angle between its azimuth and the aspect, as
/// gdaldem does after Mark ("Multidirectional, oblique-weighted, shaded-relief image of the island
/// of Hawaii", USGS Open-File Report 92-422, 1992).
class MultiShade {
 public:
  explicit MultiShade(double altitude);
  [[nodiscard]] double of(const Gradient& gradient) const;

 private:
  double sine_;
  double cosine_;
};

/// The greatest difference of two of the nine heights.
double roughness_of(const Neighbourhood& z);

/// Terrain ruggedness index: the root of the sum of squared differences to the eight neighbours
/// (Riley, DeGloria, Elliot, "A terrain ruggedness index that quantifies topographic
/// heterogeneity", 1999).
double ruggedness_of(const Neighbourhood& z);

/// Topographic position index: the height above the mean of the eight neighbours (Weiss,
/// "Topographic position and landforms analysis", 2001).
double position_of(const Neighbourhood& z);

/// The surface of Zevenbergen and Thorne (1987) through the nine heights: its coefficients D to H.
/// Heights are multiplied by `factor` first.
class CurvedSurface {
 public:
  CurvedSurface(const Neighbourhood& z, const Point<2>& sides, double factor);

  // In hundredths of a unit of height for a unit of x and y, squared. The first is the third less
  // the second.

  /// Positive where the surface bulges: -2 (D + E).
  [[nodiscard]] double curvature() const;
  /// Along the steepest line, negative where the surface bulges; 0 where it is level.
  [[nodiscard]] double profile() const;
  /// Across the steepest line, positive where the surface bulges; 0 where it is level.
  [[nodiscard]] double plan() const;

 private:
  double d_;
  double e_;
  double f_;
  double g_;
  double h_;
};

}  // namespace spillway::terrain
