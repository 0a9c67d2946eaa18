#pragma once
// What Spillway adds to formats that know comments: see docs/formats-meshes.md ("Notes").

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "src/rooms.h"

namespace spillway::formats {

/// Whether a comment is one of Spillway's own notes on a mesh: then the file is a mesh even if it
/// has no simplices.
bool is_spillway_note(std::string_view comment);

/// The notes on a coordinate system, one a comment line, without the comment sign: "crs ...",
/// several of these if the text is longer than `longest` bytes: widely used PLY readers refuse
/// lines of more than 1024.
std::vector<std::string> crs_notes(const std::string& crs, std::size_t longest = 900);

/// Appends what a comment tells of the coordinate system to `crs`. False if that is nothing.
bool read_crs_note(std::string_view comment, std::string& crs);

/// A coordinate system in one line: each line break or control character becomes a blank.
std::string one_line(std::string text);

}  // namespace spillway::formats
