#include "tools/options/former_names.h"

#include <algorithm>
#include <array>
#include <string_view>

namespace spillway::command {

namespace {

struct FormerName {
  std::string_view former;
  std::string_view present;
};

constexpr std::array<FormerName, 5> kFormerNames = {{{"base-case", "leaf-points"},
                                                     {"distrust-headers", "no-trust-headers"},
                                                     {"duplicates", "heights"},
                                                     {"tile", "tile-points"},
                                                     {"tmpdir", "scratch-folder"}}};

}  // namespace

std::string present_name(const std::string& name) {
  for (const auto& [former, present] : kFormerNames) {
    if (name == former) return std::string(present);
  }
  return name;
}

std::vector<std::string> with_present_names(std::vector<std::string> words) {
  for (std::string& word : words) {
    if (word == "--") break;
    if (!word.starts_with("--")) continue;
    const std::size_t end = std::min(word.find('='), word.size());
    word = "--" + present_name(word.substr(2, end - 2)) + word.substr(end);
  }
  return words;
}

}  // namespace spillway::command
