#include "tools/report/speed_up_estimate.h"

#include <fmt/format.h>

#include <charconv>
#include <utility>

#include "tools/report/usage_error.h"

namespace spillway::command {
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

std::string simulation_table(const std::vector<SimulatedRun>& runs) {
  std::string table = "  cores    seconds   speed-up   bottlenecks, and seconds without them";
  for (const SimulatedRun& run : runs) {
    table += fmt::format("\n{:7} {:10.4f} {:10.2f}", run.cores, run.seconds, run.speed_up);
    const char* before = "   ";
    for (const Bottleneck& bottleneck : run.bottlenecks) {
      table += fmt::format("{}{} {:.4f}", std::exchange(before, ", "), bottleneck.name,
                           bottleneck.seconds);
    }
  }
  return table;
}

}  // namespace spillway::command
