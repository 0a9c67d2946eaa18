#include "tools/options/suggestion.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <limits>
#include <numeric>
#include <utility>
#include <vector>

namespace spillway::command {
namespace {

/// How many slips make `b` of `a`: letters that are inserted, left out or replaced, neighbours that
/// change places (optimal string alignment).
std::size_t slips_between(std::string_view a, std::string_view b) {
  std::vector<std::size_t> before_last(b.size() + 1);
  std::vector<std::size_t> last(b.size() + 1);
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 0; i < a.size(); ++i) {
    std::swap(before_last, last);
    std::swap(last, row);
    row[0] = i + 1;
    for (std::size_t j = 0; j < b.size(); ++j) {
      row[j + 1] = std::min({last[j] + (a[i] == b[j] ? 0 : 1), row[j] + 1, last[j + 1] + 1});
      if (i > 0 && j > 0 && a[i] == b[j - 1] && a[i - 1] == b[j]) {
        row[j + 1] = std::min(row[j + 1], before_last[j - 1] + 1);
      }
    }
  }
  return row[b.size()];
}

/// Without the dashes that an option begins with.
std::string_view letters_of(std::string_view word) {
  return word.substr(std::min(word.find_first_not_of('-'), word.size()));
}

}  // namespace

std::string suggestion(std::string_view word, std::span<const std::string> names) {
  constexpr std::size_t kLettersOfABeginning = 3;
  constexpr std::size_t kLettersForASlip = 3;
  const std::string_view letters = letters_of(word);
  std::size_t fewest = std::numeric_limits<std::size_t>::max();
  std::string_view found;
  for (const std::string& name : names) {
    // The beginning of a name is a slip, too, however long the rest.
    const bool begins = letters.size() >= kLettersOfABeginning && name.starts_with(word);
    const std::string_view others = letters_of(name);
    const std::size_t slips = begins ? 1 : slips_between(letters, others);
    const std::size_t most = std::max(letters.size(), others.size()) / kLettersForASlip;
    if (slips >= fewest || (slips > most && !begins)) continue;
    fewest = slips;
    found = name;
  }
  return found.empty() ? "" : fmt::format(" (did you mean {}?)", found);
}

}  // namespace spillway::command
