#pragma once

#include <string>
#include <vector>

#include "src/rooms.h"

namespace spillway::command {

/// The name of an option, without dashes, for one that it had in an earlier version; any other name
/// as it is. So scripts and lists of jobs that were written then go on working.
std::string present_name(const std::string& name);

/// The words of a command line with the present names of options, up to the word "--".
std::vector<std::string> with_present_names(std::vector<std::string> words);

}  // namespace spillway::command
