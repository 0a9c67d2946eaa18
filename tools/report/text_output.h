#pragma once

#include <string>
#include <string_view>

namespace spillway::detail {

/// Writes all of `text` to a file, or to standard output if `path` is "-". Throws ClosedPipe, or
/// Error with the system's reason.
void write_text(const std::string& path, std::string_view text);

}  // namespace spillway::detail
