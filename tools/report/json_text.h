#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace spillway::detail {

/// JSON as text, on one line or indented. Bytes that are no UTF-8 (of a file's name, say) become
/// U+FFFD, since JSON cannot hold them. A line has no control characters.
std::string json_text(const nlohmann::ordered_json& json, int indent = -1);

}  // namespace spillway::detail
