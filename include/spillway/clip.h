#pragma once
// Choosing points, simplices or pixels by polygons.

#include <string>

namespace spillway {

/// What lies in polygons. What lies on an edge belongs to what is east of it, or north of a level
/// one.
struct Clip {
  /// A vector file of one layer, of any format that GDAL reads; empty: nothing is clipped. Its
  /// coordinate system must be that of what is clipped, unless that may be another one.
  std::string polygons{};
  /// Above 0, also what is no farther than this from what the file has, which may be lines and
  /// points, too; below 0: what lies so far inside of its polygons.
  double buffer = 0;
  bool outside = false;  ///< all else instead
};

}  // namespace spillway
