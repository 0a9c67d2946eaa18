#include "formats/gdal/crs_text.h"

#include <algorithm>
#include <charconv>
#include <cstddef>

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

/// The number in the last UNIT or LENGTHUNIT of WKT; 0 without.
double last_unit(std::string_view wkt) {
  constexpr std::string_view kUnit = "UNIT[";
  for (std::size_t at = wkt.rfind(kUnit); at != wkt.npos && at > 0; at = wkt.rfind(kUnit, at - 1)) {
    const std::string_view before = wkt.substr(0, at);
    if (is_letter(before.back()) && !before.ends_with("LENGTH")) continue;
    const std::size_t quote = wkt.find('"', wkt.find('"', at) + 1);
    const std::size_t begin = wkt.find_first_not_of(", ", std::min(quote + 1, wkt.size()));
    double unit = 0;
    if (begin != wkt.npos) std::from_chars(wkt.data() + begin, wkt.data() + wkt.size(), unit);
    return unit;
  }
  return 0;
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

bool may_tell_heights(std::string_view crs) {
  return is_compound_wkt(crs) || (!looks_like_wkt(crs) && crs.find('+') != crs.npos);
}

std::string_view name_in_wkt(std::string_view wkt) {
  const std::size_t quote = std::min(wkt.find('"'), wkt.size());
  const std::string_view name = wkt.substr(std::min(quote + 1, wkt.size()));
  return name.substr(0, name.find('"'));
}

CrsUnits units_in_wkt(std::string_view wkt) {
  const auto has = [&](std::string_view word) { return wkt.find(word) != wkt.npos; };
  CrsUnits units;
  units.horizontal = 0;
  units.is_geographic = (has("GEOGCS[") || has("GEOGCRS[")) && !has("PROJCS[") && !has("PROJCRS[");
  const std::size_t heights = std::min(wkt.find("VERT_CS["), wkt.find("VERTCRS["));
  if (heights == wkt.npos) return units;
  units.horizontal = last_unit(wkt.substr(0, heights));
  units.vertical = last_unit(wkt.substr(heights));
  return units;
}

bool looks_like_crs(std::string_view crs) {
  return looks_like_wkt(crs) || begins_with_word(crs, ":") ||
         crs.find('+') != std::string_view::npos;
}

}  // namespace spillway::formats
