#include "formats/gdal/crs_text.h"

#include <algorithm>

namespace spillway::formats {
namespace {

bool is_letter(char c) { return (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z'); }

/// Whether it begins with a word, as "EPSG" or "PROJCS", that ends with one of these characters.
bool begins_with_word(std::string_view text, std::string_view ends) {
  const auto is_of_word = [](char c) { return is_letter(c) || c == '_'; };
  const auto end = std::ranges::find_if_not(text, is_of_word);
  return end != text.begin() && end != text.end() && is_letter(text.front()) &&
         ends.find(*end) != std::string_view::npos;
}

}  // namespace

bool looks_like_wkt(std::string_view crs) {
  if (!begins_with_word(crs, "[(")) return false;
  bool quoted = false;
  int open = 0;
  for (const char c : crs) {
    if (c == '"') quoted = !quoted;
    if (quoted) continue;
    if (c == '[' || c == '(') ++open;
    if ((c == ']' || c == ')') && --open < 0) return false;
  }
  return open == 0 && !quoted;
}

bool is_compound_wkt(std::string_view crs) {
  return crs.starts_with("COMPD_CS") || crs.starts_with("COMPOUNDCRS");
}

bool looks_like_crs(std::string_view crs) {
  return looks_like_wkt(crs) || begins_with_word(crs, ":") ||
         crs.find('+') != std::string_view::npos;
}

}  // namespace spillway::formats
