#pragma once

#include <string>
#include <string_view>

namespace spillway {

/// Whether a comment is one of Spillway's own notes: then the file is a mesh even if it has no
/// simplices.
bool is_spillway_note(std::string_view comment);

/// Throws Error that says that the file has no faces or tetrahedra.
[[noreturn]] void fail_for_point_cloud(const std::string& file);

}  // namespace spillway
