#pragma once

#include <spillway/error.h>

#include <string>

namespace spillway::python {

/// What the error says, and what would help, in the words of Python's arguments.
std::string advised_message(const Error& error);

}  // namespace spillway::python
