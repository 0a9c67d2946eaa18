#pragma once
// How help is laid out on a terminal.

#include <cstddef>
#include <string>
#include <string_view>

#include "src/rooms.h"

namespace spillway::command {

/// Columns that help may take: what COLUMNS says, else those of the terminal that standard output
/// is, else 100; at least 40, and at most 120, as longer lines are hard to read.
std::size_t help_width();

/// Text with its lines broken at blanks, so that none has more than `width` columns as far as its
/// words allow. Lines that begin with a blank, as examples do, stay as they are.
std::string wrapped(std::string_view text, std::size_t width);

/// An entry of a list: its name, and what it means in a column beside it, on as many lines as that
/// takes. A list of words in the name may be broken after each `|`.
std::string help_entry(std::string_view name, std::string_view meaning, std::size_t width);

}  // namespace spillway::command
