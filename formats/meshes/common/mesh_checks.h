#pragma once

#include <string>
#include <string_view>

namespace spillway::detail {

/// Throws Error that says that the file of that format has no faces or tetrahedra, and what to do.
[[noreturn]] void fail_for_point_cloud(const std::string& file, std::string_view format);

}  // namespace spillway::detail
