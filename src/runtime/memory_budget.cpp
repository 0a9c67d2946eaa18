#include "src/runtime/memory_budget.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <fstream>

#include "src/error.h"

namespace spillway::runtime {
namespace {

constexpr std::uint64_t kMiB = std::uint64_t{1} << 20;
constexpr std::uint64_t kLargestDefault = 2048 * kMiB;

/// The number in a control group's file; the largest there is if it says "max" or is not there.
std::uint64_t control_group_limit(const char* path) {
  std::ifstream file(path);
  std::uint64_t bytes = 0;
  return file >> bytes ? bytes : ~std::uint64_t{0};
}

}  // namespace

std::uint64_t machine_memory() {
  const auto machine = static_cast<std::uint64_t>(::sysconf(_SC_PHYS_PAGES)) *
                       static_cast<std::uint64_t>(::sysconf(_SC_PAGESIZE));
  return std::min({machine, control_group_limit("/sys/fs/cgroup/memory.max"),
                   control_group_limit("/sys/fs/cgroup/memory/memory.limit_in_bytes")});
}

std::uint64_t default_memory_limit(unsigned processes) {
  return std::min(kLargestDefault, machine_memory() / 4 / processes);
}

std::uint64_t parse_memory_size(const std::string& text) {
  double number = 0;
  const char* const end = text.data() + text.size();
  const auto [unit, fault] = std::from_chars(text.data(), end, number, std::chars_format::fixed);
  std::string name(unit, end);
  std::transform(name.begin(), name.end(), name.begin(),
                 [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
  const std::size_t power = name.empty() ? 0 : std::string_view("KMGT").find(name[0]) + 1;
  const bool known =
      name.empty() || name == "B" ||
      (power > 0 && (name.size() == 1 || name.substr(1) == "B" || name.substr(1) == "IB"));
  const double bytes = name == "B" ? number : std::ldexp(number, static_cast<int>(10 * power));
  if (fault != std::errc() || !known || !(bytes >= 1) || bytes > 0x1p62) {
    throw InvalidArgument(fmt::format("\"{}\" is not a size; write it as 512M or 2G", text));
  }
  return static_cast<std::uint64_t>(bytes);
}

std::string memory_size_text(std::uint64_t bytes) {
  const double mebibytes = static_cast<double>(bytes) / kMiB;
  return mebibytes < 1024 ? fmt::format("{:.4g} MiB", mebibytes)
                          : fmt::format("{:.4g} GiB", mebibytes / 1024);
}

bool MemoryBudget::try_take(std::uint64_t bytes) {
  if ((used_ += bytes) <= limit_) return true;
  used_ -= bytes;
  return false;
}

void MemoryBudget::take(std::uint64_t bytes, const char* purpose, const WorkForecast* forecast) {
  if (try_take(bytes)) return;
  const std::uint64_t used = used_ + bytes;
  const double parts = static_cast<double>(whole_) / static_cast<double>(limit_);
  const auto whole_mebibytes = [parts](std::uint64_t least) {
    const double mebibytes = std::floor(static_cast<double>(least) * parts / kMiB) + 1;
    return static_cast<std::uint64_t>(mebibytes) << 20;
  };
  ErrorFacts facts;
  facts.remedy = Remedy::kMemory;
  const bool known = enough_ >= used;
  if (known) facts.enough = whole_mebibytes(enough_);
  const std::uint64_t estimate = estimate_ ? estimate_({used - bytes, bytes, forecast}) : 0;
  const std::uint64_t perhaps = std::max(estimate, used + used / 4);
  if (!known || (estimate > 0 && perhaps < enough_)) facts.perhaps = whole_mebibytes(perhaps);
  throw Failure(
      fmt::format("{} of memory are too little for {}", memory_size_text(whole_), purpose),
      ErrorCode::kOutOfBudget, std::move(facts));
}

}  // namespace spillway::runtime
