#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "formats/disk/file_system.h"
#include "src/rooms.h"

namespace spillway::formats {

/// Whether an argument is a list, a folder or a pattern, as below.
bool names_several(const std::string& argument);

/// The files that arguments stand for, in the order of the arguments:
/// - "-" and names of files: themselves, as is what names nothing that there is;
/// - a folder: the point files in it that look_into_folder() chooses, sorted; `notice` is told of
///   others;
/// - a pattern (* ? [...]) that is no file's name: what it matches, sorted;
/// - "@LIST": the lines of that file ("@-": of standard input), each a name, folder or pattern as
///   above, relative to the folder of the list; blank lines and those that begin with # are left
///   out.
/// Throws Failure for a folder without point files, a pattern that matches nothing, and an empty
/// list.
std::vector<std::string> expand_paths(
    const std::vector<std::string>& arguments,
    const std::function<void(std::string_view)>& notice = nullptr);

/// The names, folders and patterns that a list has, a line each, as they stand there. Throws
/// Failure for what cannot be in a list.
std::vector<std::string> names_in_list(InputFile& list);

}  // namespace spillway::formats
