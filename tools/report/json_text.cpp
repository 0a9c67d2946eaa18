#include "tools/report/json_text.h"

#include "tools/report/printable_text.h"

namespace spillway::command {

std::string json_text(const Json& json, int indent) {
  const std::string text = json_to_text(json, indent);
  // Of control characters JSON escapes those of ASCII itself; the others are escaped as it does.
  return indent < 0 ? printable(text) : text;
}

}  // namespace spillway::command
