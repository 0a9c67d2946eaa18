#pragma once

#include "src/rooms.h"

namespace spillway::command {

/// Lets go of the pages of the program and its libraries that are as they are in their files, of
/// which starting has used many: the system counts them as the process' memory. Those that are used
/// again come back from its cache of files. Does nothing where the system does not tell of them.
void let_go_of_program_pages();

}  // namespace spillway::command
