#pragma once
// What the user of the command can do about an error of the library, in the command's options.

#include <spillway/error.h>

#include <string>

#include "src/rooms.h"

namespace spillway::command {

/// The error's message, followed by the options that would help.
std::string advised_message(const Error& error);

}  // namespace spillway::command
