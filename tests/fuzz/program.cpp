#include "tests/fuzz/program.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "tests/fuzz/target.h"

namespace spillway::test {
namespace {

namespace fs = std::filesystem;

/// The files that were faults once, in a folder for each target.
void replay(const std::string& folder) {
  for (const FuzzTarget& target : fuzz_targets()) {
    const fs::path own = fs::path(folder) / target.name;
    if (!fs::exists(own)) continue;
    for (const fs::directory_entry& entry : fs::directory_iterator(own)) {
      fmt::print("{}\n", entry.path().string());
      std::ifstream file(entry.path(), std::ios::binary);
      const std::string bytes(std::istreambuf_iterator<char>(file), {});
      read_anything(target, bytes);
    }
  }
}

}  // namespace

std::optional<std::string> argument(std::span<char* const> arguments, std::string_view name) {
  const std::string before = fmt::format("--{}=", name);
  for (const std::string_view text : arguments) {
    if (text.starts_with(before)) return std::string(text.substr(before.size()));
  }
  return std::nullopt;
}

bool does_what_is_asked(std::span<char* const> arguments) {
  const auto is_list = [](std::string_view text) { return text == "--list"; };
  if (std::ranges::any_of(arguments, is_list)) {
    for (const FuzzTarget& target : fuzz_targets()) fmt::print("{}\n", target.name);
    return true;
  }
  if (const auto folder = argument(arguments, "seeds")) {
    write_seeds(*folder);
    return true;
  }
  if (const auto folder = argument(arguments, "replay")) {
    replay(*folder);
    return true;
  }
  return false;
}

}  // namespace spillway::test
