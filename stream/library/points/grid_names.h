#pragma once

#include <cstddef>
#include <string>

#include "src/rooms.h"

namespace spillway::stream {

/// The names of a survey's files: a path with '#' in its name, for which each file has its column
/// and row.
class GridNames {
 public:
  /// Throws InvalidArgument if the path's name has no '#', or several.
  GridNames(const std::string& path, std::size_t columns, std::size_t rows);

  /// The path of a tile's file; tiles are counted by row * columns + column.
  [[nodiscard]] std::string path(std::size_t tile) const;

  /// Throws CannotWrite if there is a file of such a name already, of this grid or of a larger or
  /// smaller one: whoever reads all files of the pattern would take it for part of the survey.
  void refuse_existing() const;

 private:
  /// Whether a file of that name might be one of a grid.
  [[nodiscard]] bool matches(const std::string& name) const;

  std::string pattern_;  ///< the whole path
  std::string before_;   ///< of the name, up to '#'
  std::string behind_;
  std::size_t columns_;
  std::size_t column_digits_;
  std::size_t row_digits_;
};

}  // namespace spillway::stream
