#pragma once

namespace spillway {

/// Which z a vertex of the plane gets where several points have the same x and y.
enum class Heights { kFirst, kLowest, kHighest, kMean };

/// Which axis a division of points cuts.
enum class Division {
  kLeastBorder,    ///< where a sample says that least is triangulated twice, else the longest side
  kLongestExtent,  ///< the longest side of the points' tight box
  kCyclingAxis,    ///< x, y, (z,) x, ... by depth
  kConstantAxis,   ///< always x
};

/// What triangulates the smallest parts. Both give the same mesh.
enum class Kernel { kSpillway, kCgal };

/// Which point stands for all of a cell of a grid.
enum class ThinChoice {
  kFirst,    ///< the first one of the input
  kLowest,   ///< that of the lowest z
  kHighest,  ///< that of the highest z
  kCenter,   ///< the nearest one to the cell's centre
};

/// What a pixel of a DEM can tell of the terrain at its centre: by the heights of the pixel and its
/// eight neighbours, where nothing else is said. Those from kMin on are of all points in the pixel,
/// by their z, points of equal x and y among them.
enum class DemProduct {
  kHeight,            ///< of the triangle there
  kSlope,             ///< steepness in degrees
  kAspect,            ///< where it falls to, in degrees from north; nothing where it is level
  kHillshade,         ///< brightness, 1 to 255
  kMultiHillshade,    ///< the same with light from four sides
  kRoughness,         ///< the greatest difference of the nine heights
  kTri,               ///< terrain ruggedness index
  kTpi,               ///< topographic position index
  kCurvature,         ///< in hundredths of a unit of height for a unit of x and y, squared
  kProfileCurvature,  ///< along the slope, likewise
  kPlanCurvature,     ///< across the slope, likewise
  kFacetSlope,        ///< steepness of the triangle there, in degrees
  kFacetAspect,       ///< where that falls to
  kFacetHillshade,    ///< its brightness, 0 to 255
  kDensity,           ///< vertices of the mesh in the pixel
  kMin,               ///< the lowest point
  kMax,               ///< the highest one
  kMean,              ///< the mean height
  kCount,             ///< how many points; 0 where there are none
  kStddev,            ///< standard deviation of the heights, of the points as the whole population
  kPercentile,        ///< the height that a percentage is not above (DemOptions::percentiles)
};

/// How the gradient at a pixel comes from its neighbours.
enum class GradientMethod {
  kHorn,               ///< all eight, those beside it counted twice
  kZevenbergenThorne,  ///< the four beside it
};

/// What a pixel of a file is.
enum class PixelType {
  kFloat32,
  kByte,  ///< whole numbers from 1; 0 is no data
};

/// A plane across an axis: where one coordinate is the same everywhere.
struct Slice {
  int axis = 2;  ///< 0: x, 1: y, 2: z
  double value = 0;
};

}  // namespace spillway
