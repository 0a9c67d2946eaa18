#include "tools/options/suggestion.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <vector>

namespace spillway::detail {
namespace {

/// How many letters have to be inserted, left out or replaced to make `b` of `a` (Levenshtein).
std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 0; i < a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i + 1;
    for (std::size_t j = 0; j < b.size(); ++j) {
      const std::size_t replaced = diagonal + (a[i] == b[j] ? 0 : 1);
      diagonal = row[j + 1];
      row[j + 1] = std::min({replaced, row[j] + 1, row[j + 1] + 1});
    }
  }
  return row[b.size()];
}

}  // namespace

std::string suggestion(std::string_view word, std::span<const std::string> names) {
  std::size_t nearest = word.size() / 3 + 2;
  std::string_view found;
  for (const std::string& name : names) {
    // The beginning of a name is a slip, too, however long the rest.
    const bool begins = word.size() > 3 && name.starts_with(word);
    const std::size_t distance = begins ? 1 : edit_distance(word, name);
    if (distance >= nearest) continue;
    nearest = distance;
    found = name;
  }
  return found.empty() ? "" : fmt::format(" (did you mean {}?)", found);
}

}  // namespace spillway::detail
