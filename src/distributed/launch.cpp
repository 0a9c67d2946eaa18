// How this process was started, as its environment tells.

#include <unistd.h>

#include <algorithm>
#include <charconv>
#include <cstdlib>
#include <cstring>
#include <string>
#include <string_view>
#include <system_error>
#include <vector>

#include "src/distributed/ranks.h"

namespace spillway::distributed {
namespace {

/// The number that the variable of the environment starts with; `least` if that is none, or less.
int number_in(const char* variable, int least = 1) {
  const char* const text = std::getenv(variable);
  if (text == nullptr) {
    return least;
  }
  int number = 0;
  const auto parsed = std::from_chars(text, text + std::strlen(text), number);
  return parsed.ec == std::errc{} ? std::max(number, least) : least;
}

}  // namespace

Launch launch() {
  Launch launch;
  if (std::getenv("OMPI_COMM_WORLD_SIZE") != nullptr) {
    launch.ranks = number_in("OMPI_COMM_WORLD_SIZE");
    launch.ranks_here = number_in("OMPI_COMM_WORLD_LOCAL_SIZE");
    launch.rank = number_in("OMPI_COMM_WORLD_RANK", 0);
    launch.as_ranks = true;
  } else if (std::getenv("PMIX_RANK") != nullptr) {
    // Slurm; tasks per node are written like "2(x3),1".
    launch.ranks = number_in("SLURM_STEP_NUM_TASKS");
    launch.ranks_here = number_in("SLURM_STEP_TASKS_PER_NODE");
    launch.rank = number_in("PMIX_RANK", 0);
    launch.as_ranks = true;
  }
  launch.ranks_here = std::min(launch.ranks, launch.ranks_here);
  return launch;
}

void forget_launch() {
  std::vector<std::string> names;
  for (char** entry = environ; *entry != nullptr; ++entry) {
    const std::string_view text = *entry;
    if (text.starts_with("OMPI_") || text.starts_with("PMIX_") || text.starts_with("PMI_")) {
      names.emplace_back(text.substr(0, text.find('=')));
    }
  }
  for (const std::string& name : names) {
    unsetenv(name.c_str());
  }
}

}  // namespace spillway::distributed
