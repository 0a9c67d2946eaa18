#include "tools/report/speed_up_estimate.h"

#include <fmt/format.h>

#include <charconv>
#include <utility>

#include "tools/report/usage_error.h"

namespace spillway::detail {
namespace {

constexpr unsigned kMostCores = 1U << 20;

[[noreturn]] void refuse(std::string_view text) {
  throw UsageError(fmt::format("'{}' is not a list like 1,2,8 or 1,2,4,...,1024 of 1 to {} cores",
                               text, kMostCores));
}

}  // namespace

std::vector<unsigned> parse_core_list(std::string_view text) {
  std::vector<unsigned> cores;
  bool doubling = false;
  for (std::string_view rest = text;;) {
    const std::size_t comma = rest.find(',');
    const std::string_view word = rest.substr(0, comma);
    if (word == "...") {
      if (cores.empty() || doubling) refuse(text);
      doubling = true;
    } else {
      unsigned number = 0;
      const auto parsed = std::from_chars(word.data(), word.data() + word.size(), number);
      if (parsed.ec != std::errc{} || parsed.ptr != word.data() + word.size() || number == 0 ||
          number > kMostCores) {
        refuse(text);
      }
      while (doubling && 2 * cores.back() < number) cores.push_back(2 * cores.back());
      doubling = false;
      cores.push_back(number);
    }
    if (comma == std::string_view::npos) break;
    rest.remove_prefix(comma + 1);
  }
  if (doubling) refuse(text);
  return cores;
}

void TaskTree::add(TaskNode node) {
  for (const std::uint32_t child : node.children) {
    node.task.children.push_back(std::move(roots_.extract(child).mapped()));
  }
  roots_.emplace(node.number, std::move(node.task));
}

Task TaskTree::take() {
  return roots_.empty() ? Task() : std::move(roots_.extract(roots_.begin()).mapped());
}

std::vector<SimulatedRun> simulate_cores(const Task& tasks, const std::vector<unsigned>& cores) {
  const double alone = greedy_makespan(tasks, 1);
  std::vector<SimulatedRun> runs;
  for (const unsigned count : cores) {
    const double seconds = greedy_makespan(tasks, count);
    runs.push_back({count, seconds, seconds > 0 ? alone / seconds : 1});
  }
  return runs;
}

std::string simulation_table(const std::vector<SimulatedRun>& runs) {
  std::string table = "  cores    seconds   speed-up";
  for (const SimulatedRun& run : runs) {
    table += fmt::format("\n{:7} {:10.4f} {:10.2f}", run.cores, run.seconds, run.speed_up);
  }
  return table;
}

}  // namespace spillway::detail
