#pragma once

#include <string>
#include <vector>

#include "src/terrain/line_squares.h"

namespace spillway::stream {

/// Throws InvalidArgument for tiles that are squares of a side and polygons of a file.
void refuse_two_kinds(double side, const std::string& polygons);

/// The names of files for squares of a side: "{x}" and "{y}" in a pattern become the south-western
/// corner of each.
class SquareNames {
 public:
  /// Throws InvalidArgument if the name of the file `pattern` has not both of them once, or the
  /// side is not above 0.
  SquareNames(std::string pattern, double side);

  [[nodiscard]] double side() const { return side_; }
  [[nodiscard]] std::string path(GridSquare square) const;
  /// The files in the folder whose names could be those of other squares, sorted.
  [[nodiscard]] std::vector<std::string> others_than(std::vector<std::string> paths) const;

 private:
  std::string pattern_;
  double side_;
};

}  // namespace spillway::stream
