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

/// What a pixel of a DEM can tell of the terrain at its centre.
enum class DemProduct {
  kHeight,     ///< of the triangle there
  kSlope,      ///< its steepness in degrees
  kAspect,     ///< where it falls to, in degrees from north; nothing where it is level
  kHillshade,  ///< its brightness, 0 to 255
  kDensity,    ///< vertices of the mesh in the pixel
};

/// A plane across an axis: where one coordinate is the same everywhere.
struct Slice {
  int axis = 2;  ///< 0: x, 1: y, 2: z
  double value = 0;
};

}  // namespace spillway
