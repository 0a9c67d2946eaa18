#pragma once

#include <string>

#include "formats/bytes/json.h"

namespace spillway::command {

/// As json_to_text(), but a line has no control characters.
std::string json_text(const Json& json, int indent = -1);

}  // namespace spillway::command
