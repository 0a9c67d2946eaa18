#pragma once

#include <string>

namespace spillway {

/// A file that PointOptions::skip_broken left out.
struct SkippedFile {
  std::string path{};
  std::string message{};  ///< why, with the name of the file: what the Error would have said
};

}  // namespace spillway
