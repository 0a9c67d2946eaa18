#pragma once

#include <string>
#include <string_view>

#include "src/rooms.h"

namespace spillway::command {

/// Writes all of `text` to a file, or to standard output if `path` is "-". Throws ClosedPipe, or
/// Failure with the system's reason.
void write_text(const std::string& path, std::string_view text);

}  // namespace spillway::command
