#include "stream/checkpoint/run_identity.h"

#include <fmt/chrono.h>
#include <fmt/format.h>
#include <sys/stat.h>

#include <algorithm>
#include <cstddef>

namespace spillway::stream {
namespace {

/// What changes when a file does.
std::string state_of_file(const std::string& path) {
  struct stat status {};
  if (path == "-" || ::stat(path.c_str(), &status) != 0 || !S_ISREG(status.st_mode)) {
    return "a pipe";
  }
  return fmt::format("{} bytes of {:%Y-%m-%d %H:%M:%S}.{:09} UTC", status.st_size,
                     fmt::gmtime(status.st_mtim.tv_sec), status.st_mtim.tv_nsec);
}

}  // namespace

void RunIdentity::add_file(std::string name, const std::string& path) {
  add(std::move(name), fmt::format("{} ({})", path, state_of_file(path)));
}

std::string RunIdentity::value_of(std::string_view name) const {
  const auto found = std::ranges::find(facts_, name, &Fact::name);
  return found == facts_.end() ? "" : found->value;
}

std::string RunIdentity::difference_from(const RunIdentity& earlier) const {
  constexpr std::size_t kMostNamed = 3;
  std::vector<std::string> differences;
  const auto find = [](const std::vector<Fact>& facts, const std::string& name) {
    return std::ranges::find(facts, name, &Fact::name);
  };
  for (const Fact& fact : facts_) {
    const auto was = find(earlier.facts_, fact.name);
    if (was == earlier.facts_.end()) {
      differences.push_back(fmt::format("there was no {}", fact.name));
    } else if (was->value != fact.value) {
      differences.push_back(fmt::format("{} is {}, and was {}", fact.name, fact.value, was->value));
    }
  }
  for (const Fact& fact : earlier.facts_) {
    if (find(facts_, fact.name) == facts_.end()) {
      differences.push_back(fmt::format("there is no {} any more", fact.name));
    }
  }
  if (differences.size() > kMostNamed) {
    const std::size_t more = differences.size() - kMostNamed;
    differences.resize(kMostNamed);
    differences.push_back(fmt::format("{} more", more));
  }
  return fmt::format("{}", fmt::join(differences, "; "));
}

}  // namespace spillway::stream
