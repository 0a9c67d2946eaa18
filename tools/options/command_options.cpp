#include "tools/options/command_options.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <system_error>
#include <utility>

#include "src/distributed/ranks.h"
#include "src/error.h"
#include "src/runtime/memory_budget.h"
#include "tools/process/rank_job.h"

namespace spillway::detail {
namespace {

/// A check that help does not speak of; `wrong` says what is wrong with a text, nothing if it is
/// right, and may write it in another way.
CLI::Option* check_by(CLI::Option* option, std::function<std::string(std::string&)> wrong) {
  return option->transform(CLI::Validator(std::move(wrong), ""));
}

std::vector<double> parse_numbers(const std::string& text) {
  std::vector<double> numbers;
  for (std::size_t begin = 0; begin <= text.size();) {
    const std::size_t end = std::min(text.find(',', begin), text.size());
    const std::string_view part = std::string_view(text).substr(begin, end - begin);
    const auto number = parse_number(part);
    if (!number) {
      throw UsageError(
          fmt::format("\"{}\" is no number; give several with commas between them", part));
    }
    numbers.push_back(*number);
    begin = end + 1;
  }
  return numbers;
}

/// Makes an option refuse all but these words, which become its value name.
CLI::Option* take_choice(CLI::Option* option, const std::vector<std::string>& words) {
  return option->check(CLI::IsMember(words).description(""))
      ->type_name(fmt::format("{}", fmt::join(words, "|")));
}

}  // namespace

HelpFormatter::HelpFormatter() { column_width(34); }

std::string HelpFormatter::make_option_opts(const CLI::Option* option) const {
  const bool many = takes_many(*option);
  if (option->get_positional()) return many ? "..." : "";
  if (option->get_type_size() == 0) return "";
  return " " + option->get_type_name() + (many ? "..." : "");
}

std::string HelpFormatter::make_option_desc(const CLI::Option* option) const {
  std::string text = option->get_description();
  if (option->get_required() && !option->get_positional()) text += " [required]";
  if (!option->get_default_str().empty()) text += " [" + option->get_default_str() + "]";
  return text;
}

void add_memory_options(CLI::App& app, MemoryOptions& options) {
  take_parsed(
      app.add_option("--memory", options.limit,
                     "Memory to keep to, as 512M or 2G [a quarter of the machine's, at most 2G]"),
      parse_memory_size)
      ->type_name("SIZE");
  app.add_option("--tmpdir", options.scratch_parent,
                 "Folder for what does not fit into memory [$TMPDIR, else /tmp]")
      ->type_name("DIR");
  take_parsed(app.add_option("--max-tmp", options.scratch_cap,
                             "Most of the disk to use for that [no limit]"),
              parse_memory_size)
      ->type_name("SIZE");
}

std::uint64_t memory_limit(const MemoryOptions& options) {
  if (!options.limit.empty()) return parse_memory_size(options.limit);
  return default_memory_limit(static_cast<unsigned>(distributed::launch().ranks_here));
}

std::unique_ptr<ScratchFolder> make_scratch_folder(const MemoryOptions& options) {
  std::optional<std::uint64_t> cap;
  if (!options.scratch_cap.empty()) cap = parse_memory_size(options.scratch_cap);
  // What was asked for by name is tried at once, not when hours of work are to be written there.
  const std::string& parent = options.scratch_parent;
  if (!parent.empty() && ::access((parent + "/.").c_str(), W_OK | X_OK) != 0) {
    throw Error(fmt::format("--tmpdir: cannot write to {}: {}", parent,
                            std::generic_category().message(errno)));
  }
  return make_scratch_folder(parent, cap);
}

std::vector<std::string_view> given_options(const CLI::App& app,
                                            std::span<const std::string_view> options) {
  std::vector<std::string_view> given;
  for (const std::string_view name : options) {
    const CLI::Option* const option = app.get_option_no_throw(std::string(name));
    if (option != nullptr && option->count() > 0) given.push_back(name);
  }
  return given;
}

void refuse_given(const CLI::App& app, std::span<const std::string_view> options,
                  std::string_view where) {
  std::vector<std::string_view> given = given_options(app, options);
  if (given.empty()) return;
  const std::string_view last = given.back();
  given.pop_back();
  throw UsageError(fmt::format("{}{}{} {} no effect {}: leave {} away", fmt::join(given, ", "),
                               given.empty() ? "" : " and ", last, given.empty() ? "has" : "have",
                               where, given.empty() ? "it" : "them"));
}

CLI::Option* add_choice(CLI::App& app, const std::string& name, std::string& value,
                        const std::vector<std::string>& words, const std::string& description) {
  CLI::Option* option = take_choice(app.add_option(name, value, description), words);
  if (!value.empty()) option->default_str(value);
  return option;
}

CLI::Option* add_dimension(CLI::App& app, int& dimension, const std::string& description) {
  return take_choice(app.add_option("--dim", dimension, description), {"2", "3"})
      ->default_str(std::to_string(dimension));
}

CLI::Option* take_one_list(CLI::Option* option) {
  return option->delimiter(',')->allow_extra_args(false);
}

bool takes_many(const CLI::Option& option) {
  return option.get_expected_max() == CLI::detail::expected_max_vector_size &&
         option.get_allow_extra_args();
}

void add_report_options(CLI::App& app, ReportOptions& options) {
  add_choice(app, "--progress", options.progress, {"auto", "plain", "json", "none"},
             "Progress on standard error");
  CLI::Option* quiet =
      app.add_flag("-q,--quiet", options.quiet, "Say nothing on standard error but errors");
  app.add_flag("-v,--verbose", options.verbose, "Say more")->excludes(quiet);
}

Progress make_progress(const ReportOptions& options, bool reads_pipe) {
  if (!is_first_rank()) return {ProgressStyle::kNone, true, false};
  ProgressStyle style = ProgressStyle::kPlain;
  if (options.quiet || options.progress == "none") {
    style = ProgressStyle::kNone;
  } else if (options.progress == "json") {
    style = ProgressStyle::kJson;
  } else if (options.progress == "auto" && isatty(STDERR_FILENO) != 0) {
    const char* terminal = std::getenv("TERM");
    if (terminal != nullptr && std::string_view(terminal) != "dumb") {
      style = reads_pipe ? ProgressStyle::kNone : ProgressStyle::kTerminal;
    }
  }
  return {style, options.quiet, options.verbose};
}

std::optional<double> parse_number(std::string_view text) {
  if (text.size() > 1 && text[0] == '+' && text[1] != '-') text.remove_prefix(1);
  double number = 0;
  const auto [end, fault] = std::from_chars(text.data(), text.data() + text.size(), number);
  const bool whole = fault == std::errc() && end == text.data() + text.size();
  return whole && std::isfinite(number) ? std::optional(number) : std::nullopt;
}

CLI::Option* take_whole_number(CLI::Option* option, std::uint64_t least, std::uint64_t most) {
  return check_by(option, [least, most](std::string& text) -> std::string {
    std::uint64_t number = 0;
    const char* const last = text.data() + text.size();
    const auto [end, fault] = std::from_chars(text.data(), last, number);
    if (fault == std::errc() && end == last && number >= least && number <= most) {
      text = fmt::format("{}", number);  // not taken for octal
      return "";
    }
    if (most == std::numeric_limits<std::uint64_t>::max()) {
      return fmt::format("\"{}\" is no whole number of at least {}", text, least);
    }
    return fmt::format("\"{}\" is no whole number from {} to {}", text, least, most);
  });
}

CLI::Option* take_number(CLI::Option* option) {
  return check_by(option, [](std::string& text) -> std::string {
    return parse_number(text) ? "" : fmt::format("\"{}\" is no number", text);
  });
}

CLI::Option* take_positive_number(CLI::Option* option) {
  return check_by(option, [](std::string& text) -> std::string {
    return parse_number(text).value_or(0) > 0 ? ""
                                              : fmt::format("\"{}\" is no number above 0", text);
  });
}

CLI::Option* take_number_between(CLI::Option* option, double least, double most) {
  return check_by(option, [least, most](std::string& text) -> std::string {
    const auto number = parse_number(text);
    if (number && *number >= least && *number <= most) return "";
    return fmt::format("\"{}\" is no number from {} to {}", text, least, most);
  });
}

CLI::Option* take_parsed(CLI::Option* option, std::function<void(const std::string& text)> parse) {
  return check_by(option, [parse = std::move(parse)](std::string& text) -> std::string {
    try {
      parse(text);
      return "";
    } catch (const UsageError& error) {
      return error.what();
    }
  });
}

CLI::Option* add_number_list(CLI::App& app, const std::string& name, std::vector<double>& values,
                             const std::string& description, bool positive) {
  const auto keep = [&values](const std::vector<std::string>& texts) {
    values.clear();
    for (const std::string& text : texts) {
      const std::vector<double> numbers = parse_numbers(text);
      values.insert(values.end(), numbers.begin(), numbers.end());
    }
  };
  CLI::Option* const option =
      app.add_option_function<std::vector<std::string>>(name, keep, description);
  return take_parsed(option->allow_extra_args(false), [positive](const std::string& text) {
    const std::vector<double> numbers = parse_numbers(text);
    const auto wrong = std::ranges::find_if(numbers, [](double number) { return number <= 0; });
    if (positive && wrong != numbers.end()) {
      throw UsageError(fmt::format("\"{}\" is no number above 0", *wrong));
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

}  // namespace spillway::detail
