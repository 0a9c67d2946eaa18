#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "src/rooms.h"

namespace spillway::formats {

/// What a folder has of point files.
struct PointFolder {
  std::vector<std::string> files;  ///< those that the folder stands for, sorted
  std::string kind;                ///< what these are, for messages: "LAS and LAZ", ".xyz"
  /// Names of the other point files in it, without the folder, sorted: check points beside tiles,
  /// a readme.
  std::vector<std::string> left_out;
  std::size_t of_meshes = 0;  ///< files of meshes in several files, which are left out, too
};

/// The names of the formats of meshes in several files, for messages.
std::string formats_in_files();

/// Looks at the names in a folder. What lies beside tiles is not meant by the folder's name, so it
/// stands for files of one kind: LAS and LAZ if there are any, else those with the extension that
/// most files have; of as many, those that are not text. Hidden files and folders below are not
/// looked at. Throws Failure for a folder that cannot be read or has no point files.
PointFolder look_into_folder(const std::string& folder);

}  // namespace spillway::formats
