#pragma once

#include "src/rooms.h"

namespace spillway::command {

/// Puts something in place of those of standard input, output and error that are closed, so that no
/// file which is opened later gets their numbers. Reading such an input or writing such an output
/// fails; what goes to standard error is lost. The first thing to do in main. Ends the process with
/// exit code 1 where that cannot be done.
void open_standard_descriptors();

}  // namespace spillway::command
