#include "tools/report/json_text.h"

#include "tools/report/printable_text.h"

namespace spillway::detail {

std::string json_text(const nlohmann::ordered_json& json, int indent) {
  const std::string text =
      json.dump(indent, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
  // Of control characters JSON escapes those of ASCII itself; the others are escaped as it does.
  return indent < 0 ? printable(text) : text;
}

}  // namespace spillway::detail
