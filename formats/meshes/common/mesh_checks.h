#pragma once

#include <string>
#include <string_view>

namespace spillway::detail {

/// Whether a comment is one of Spillway's own notes: then the file is a mesh even if it has no
/// simplices.
bool is_spillway_note(std::string_view comment);

/// Whether a file's first bytes are this word, and nothing that makes it longer.
bool begins_with_word(std::string_view first_bytes, std::string_view word);

/// Throws Error that says that the file of that format has no faces or tetrahedra, and what to do.
[[noreturn]] void fail_for_point_cloud(const std::string& file, std::string_view format);

}  // namespace spillway::detail
