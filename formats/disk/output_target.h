#pragma once

#include <sys/types.h>

#include <optional>
#include <string>

#include "src/rooms.h"

namespace spillway::formats {

/// Where an output goes.
struct OutputTarget {
  std::string path;            ///< through symbolic links, also one to what is yet to be made
  bool regular = true;         ///< false for what is there and no regular file: a pipe, a device
  std::optional<mode_t> mode;  ///< permissions of the file that will be replaced; none if it is new
};

/// The target of an output called `name`. Throws InvalidArgument for an empty name, and Failure for a
/// folder, a write-protected file and what the system refuses.
OutputTarget output_target(const std::string& name);

/// Throws Failure: that `name` cannot be created, the system's reason, and what can be done.
[[noreturn]] void fail_to_create(const std::string& name, int error);

/// What the user can do about an error when `name` is created or written: "; ...", or "".
std::string output_hint(int error, const std::string& name);

}  // namespace spillway::formats
