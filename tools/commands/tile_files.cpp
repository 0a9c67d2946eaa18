#include "tools/commands/tile_files.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>

#include "tools/report/usage_error.h"

namespace spillway::command {

void refuse_pattern(const std::string& output) {
  const std::string name = std::filesystem::path(output).filename();
  const std::size_t brace = name.find('{');
  if (brace == std::string::npos || name.find('}', brace) == std::string::npos) return;
  throw UsageError(fmt::format("{}: braces in a name are for tiles; give --tiles, too", output));
}

void warn_of_other_tiles(const std::vector<std::string>& files, const std::string& output,
                         ProgressLine& progress) {
  constexpr std::size_t kMostNamed = 3;
  if (files.empty()) return;
  const std::size_t named = std::min(files.size(), kMostNamed);
  const std::size_t more = files.size() - named;
  progress.insist(fmt::format(
      "warning: {}{} are called like tiles of {}, but this run has not written them",
      fmt::join(files.begin(), files.begin() + static_cast<std::ptrdiff_t>(named), ", "),
      more == 0 ? "" : fmt::format(" and {} more", more), output));
}

}  // namespace spillway::command
