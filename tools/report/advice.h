#pragma once
// What the user of the command can do about an error of the library, in the command's options.

#include <spillway/error.h>

#include <string>

namespace spillway::detail {

/// The error's message, followed by the options that would help.
std::string advised_message(const spillway::Error& error);

}  // namespace spillway::detail
