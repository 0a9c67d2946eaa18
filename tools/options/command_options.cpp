#include "tools/options/command_options.h"

#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <system_error>
#include <utility>

#include "src/distributed/ranks.h"
#include "src/runtime/memory_budget.h"
#include "tools/process/rank_job.h"
#include "tools/report/usage_error.h"

namespace spillway::command {
namespace {

std::vector<double> parse_numbers(const std::string& text) {
  std::vector<double> numbers;
  for (std::size_t begin = 0; begin <= text.size();) {
    const std::size_t end = std::min(text.find(',', begin), text.size());
    const std::string_view part = std::string_view(text).substr(begin, end - begin);
    const auto number = parse_number(part);
    if (!number) {
      throw UsageError(
          fmt::format("\"{}\" is not a number; give several with commas between them", part));
    }
    numbers.push_back(*number);
    begin = end + 1;
  }
  return numbers;
}

bool is_pipe(int file) {
  struct stat status {};
  return ::fstat(file, &status) == 0 && S_ISFIFO(status.st_mode);
}

/// Says that the limit is more than there is.
void warn_of_memory(const MemoryOptions& options, ProgressLine& progress) {
  if (options.limit.empty()) return;
  const std::uint64_t limit = parse_memory_size(options.limit);
  const std::uint64_t there = machine_memory();
  const auto processes = static_cast<std::uint64_t>(distributed::launch().ranks_here);
  if (limit <= there / processes) return;
  progress.say(fmt::format(
      "warning: --memory {}{} is more than the {} that this machine has, so the run may be killed "
      "for it; a limit below keeps what is too much on the disk",
      options.limit, processes > 1 ? fmt::format(" of {} processes", processes) : "",
      memory_size_text(there)));
}

}  // namespace

void add_memory_options(CommandLine& app, MemoryOptions& options) {
  take_parsed(
      app.add_option("--memory", options.limit,
                     "Memory to keep to, as 512M or 2G [a quarter of the machine's, at most 2G]"),
      parse_memory_size)
      .value_name("SIZE")
      .group(kResourceGroup);
  app.add_option("--scratch-folder", options.scratch_parent,
                 "Folder for what does not fit into memory [$TMPDIR, else /tmp]")
      .value_name("DIR")
      .group(kResourceGroup);
  take_parsed(app.add_option("--max-tmp", options.scratch_cap,
                             "Most of the disk to use for that [no limit]"),
              parse_memory_size)
      .value_name("SIZE")
      .group(kResourceGroup);
}

std::uint64_t memory_limit(const MemoryOptions& options) {
  if (!options.limit.empty()) return parse_memory_size(options.limit);
  return default_memory_limit(static_cast<unsigned>(distributed::launch().ranks_here));
}

ContextOptions context_options(const MemoryOptions& options, unsigned threads,
                               ProgressLine& progress) {
  // What was asked for by name is tried at once, not when hours of work are to be written there.
  const std::string& parent = options.scratch_parent;
  if (!parent.empty() && ::access((parent + "/.").c_str(), W_OK | X_OK) != 0) {
    throw Failure(fmt::format("--scratch-folder: cannot write to {}: {}", parent,
                              std::generic_category().message(errno)));
  }
  warn_of_memory(options, progress);
  return {.memory = fmt::format("{}", memory_limit(options)),
          .threads = threads,
          .scratch_folder = parent,
          .scratch_limit = options.scratch_cap,
          .progress = [&progress](const Progress& state) { progress.tell(state); },
          .warning = [&progress](std::string_view text) { progress.say(text); },
          .detail = [&progress](std::string_view text) { progress.detail(text); }};
}

std::vector<std::string_view> given_options(const CommandLine& app,
                                            std::span<const std::string_view> options) {
  std::vector<std::string_view> given;
  for (const std::string_view name : options) {
    if (app.is_given(name)) given.push_back(name);
  }
  return given;
}

void refuse_given(const CommandLine& app, std::span<const std::string_view> options,
                  std::string_view where) {
  std::vector<std::string_view> given = given_options(app, options);
  if (given.empty()) return;
  const std::string_view last = given.back();
  given.pop_back();
  throw UsageError(fmt::format("{}{}{} {} no effect {}: leave {} out", fmt::join(given, ", "),
                               given.empty() ? "" : " and ", last, given.empty() ? "has" : "have",
                               where, given.empty() ? "it" : "them"));
}

Option add_choice(CommandLine& app, const std::string& name, std::string& value,
                  const std::vector<std::string>& words, const std::string& description) {
  Option option = app.add_option(name, value, description);
  option.one_of(words).value_name(fmt::format("{}", fmt::join(words, "|")));
  if (!value.empty()) option.show_default(value);
  return option;
}

Option add_attributes(CommandLine& app, std::string& list, const std::string& description) {
  return app.add_option("--attributes", list, description).value_name("all|none|NAME,...");
}

std::optional<std::vector<std::string>> attribute_names(const std::string& list) {
  if (list.empty()) return std::nullopt;
  std::vector<std::string> names;
  if (list == "none") return names;
  for (std::size_t begin = 0; begin <= list.size();) {
    const std::size_t end = std::min(list.find(',', begin), list.size());
    names.push_back(list.substr(begin, end - begin));
    begin = end + 1;
  }
  return names;
}

Option add_dimension(CommandLine& app, int& dimension, const std::string& description,
                     int largest) {
  std::vector<std::string> dimensions;
  for (int d = 2; d <= largest; ++d) dimensions.push_back(std::to_string(d));
  const std::string names = fmt::format("{}", fmt::join(dimensions, "|"));
  return app.add_option("--dim", dimension, description)
      .one_of(dimensions)
      .value_name(names)
      .show_default(std::to_string(dimension));
}

void add_report_options(CommandLine& app, ReportOptions& options) {
  add_choice(app, "--progress", options.progress, {"auto", "plain", "json", "none"},
             "Progress on standard error")
      .group(kReportGroup);
  app.add_option("--stats", options.stats_path, "Write figures of the run, as JSON")
      .value_name("FILE")
      .group(kReportGroup);
  const Option quiet =
      app.add_flag("-q,--quiet", options.quiet, "Say nothing on standard error but errors")
          .group(kReportGroup);
  app.add_flag("-v,--verbose", options.verbose, "Say more").group(kReportGroup).excludes(quiet);
}

ProgressLine make_progress(const ReportOptions& options, std::string_view output) {
  if (!is_first_rank()) return {ProgressStyle::kNone, true, false};
  ProgressStyle style = ProgressStyle::kPlain;
  if (options.quiet || options.progress == "none") {
    style = ProgressStyle::kNone;
  } else if (options.progress == "json") {
    style = ProgressStyle::kJson;
  } else if (options.progress == "auto" && isatty(STDERR_FILENO) != 0) {
    const char* terminal = std::getenv("TERM");
    if (terminal != nullptr && std::string_view(terminal) != "dumb") {
      style = output == "-" && is_pipe(STDOUT_FILENO) ? ProgressStyle::kEndsOnTerminal
                                                      : ProgressStyle::kTerminal;
    }
  }
  return {style, options.quiet, options.verbose};
}

Option take_whole_number(Option option, std::uint64_t least, std::uint64_t most) {
  return option.check([least, most](std::string& text) -> std::string {
    std::uint64_t number = 0;
    const char* const last = text.data() + text.size();
    const auto [end, fault] = std::from_chars(text.data(), last, number);
    if (fault == std::errc() && end == last && number >= least && number <= most) {
      text = fmt::format("{}", number);  // not taken for octal
      return "";
    }
    if (most == std::numeric_limits<std::uint64_t>::max()) {
      return fmt::format("\"{}\" is not a whole number of at least {}", text, least);
    }
    return fmt::format("\"{}\" is not a whole number from {} to {}", text, least, most);
  });
}

Option take_number(Option option) {
  return option.check([](std::string& text) -> std::string {
    return parse_number(text) ? "" : fmt::format("\"{}\" is not a number", text);
  });
}

Option take_positive_number(Option option) {
  return option.check([](std::string& text) -> std::string {
    return parse_number(text).value_or(0) > 0 ? ""
                                              : fmt::format("\"{}\" is not a number above 0", text);
  });
}

Option take_number_between(Option option, double least, double most) {
  return option.check([least, most](std::string& text) -> std::string {
    const auto number = parse_number(text);
    if (number && *number >= least && *number <= most) return "";
    return fmt::format("\"{}\" is not a number from {} to {}", text, least, most);
  });
}

Option take_parsed(Option option, std::function<void(const std::string& text)> parse) {
  return option.check([parse = std::move(parse)](std::string& text) -> std::string {
    try {
      parse(text);
      return "";
    } catch (const InvalidArgument& error) {
      return error.what();
    }
  });
}

Option add_number_list(CommandLine& app, const std::string& name, std::vector<double>& values,
                       const std::string& description, bool positive) {
  const auto keep = [&values](const std::vector<std::string>& texts) {
    values.clear();
    for (const std::string& text : texts) {
      const std::vector<double> numbers = parse_numbers(text);
      values.insert(values.end(), numbers.begin(), numbers.end());
    }
  };
  return take_parsed(
      app.add_option(name, keep, description).one_argument(), [positive](const std::string& text) {
        const std::vector<double> numbers = parse_numbers(text);
        const auto wrong = std::ranges::find_if(numbers, [](double number) { return number <= 0; });
        if (positive && wrong != numbers.end()) {
          throw UsageError(fmt::format("\"{}\" is not a number above 0", *wrong));
        }
      });
}

std::uint64_t parse_point_count(std::string_view text) {
  std::uint64_t count = 0;
  const char* end = text.data() + text.size();
  const auto whole = std::from_chars(text.data(), end, count);
  if (!text.empty() && whole.ec == std::errc{} && whole.ptr == end) return count;
  double value = -1;
  const auto scientific = std::from_chars(text.data(), end, value);
  constexpr double kLargest = 9007199254740992.0;  // 2^53: whole numbers are exact up to here
  if (scientific.ec != std::errc{} || scientific.ptr != end || !(value >= 0 && value <= kLargest) ||
      value != std::floor(value)) {
    throw UsageError(fmt::format("'{}' is not a number of points: write 1000000 or 1e6", text));
  }
  return static_cast<std::uint64_t>(value);
}

}  // namespace spillway::command
