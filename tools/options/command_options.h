#pragma once
// What several subcommands' options have in common.

#include <spillway/context.h>

#include <cstdint>
#include <functional>
#include <initializer_list>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "src/parallel/most_threads.h"
#include "tools/options/command_line.h"
#include "tools/report/progress.h"

namespace spillway::command {

/// --progress, -q, -v.
struct ReportOptions {
  std::string progress = "auto";
  bool quiet = false;
  bool verbose = false;
  std::string stats_path;
};
void add_report_options(CommandLine& app, ReportOptions& options);

/// The reporter that the options ask for. "auto" is a rewritten line on a terminal, else plain
/// lines; of several ranks the first one reports. `output` is the run's file, if it has one: if that
/// is a pipe, whoever reads it has the line of the terminal.
ProgressLine make_progress(const ReportOptions& options, std::string_view output = "");

/// --memory, --scratch-folder, --max-tmp.
struct MemoryOptions {
  std::string limit;
  std::string scratch_parent;
  std::string scratch_cap;
};
void add_memory_options(CommandLine& app, MemoryOptions& options);

/// What --memory says, or the default. Throws UsageError.
std::uint64_t memory_limit(const MemoryOptions& options);

/// What a run may take and whom it tells, for the library: phases, warnings and details go to
/// `progress`, which must outlive it. Throws UsageError, and Failure if the folder of --scratch-folder cannot
/// be written to.
ContextOptions context_options(const MemoryOptions& options, unsigned threads,
                               ProgressLine& progress);

/// Those of these options that were given to the subcommand. What it does not have is never given.
std::vector<std::string_view> given_options(const CommandLine& app,
                                            std::span<const std::string_view> options);

/// Throws UsageError if any of these options was given to the subcommand: "--id and --every have no
/// effect WHERE: leave them out".
void refuse_given(const CommandLine& app, std::span<const std::string_view> options,
                  std::string_view where);
inline void refuse_given(const CommandLine& app, std::initializer_list<std::string_view> options,
                         std::string_view where) {
  refuse_given(app, std::span(options.begin(), options.size()), where);
}

/// An option that takes one of some words. The words become its value name, separated by `|`, which
/// is also where completion and manual find them.
Option add_choice(CommandLine& app, const std::string& name, std::string& value,
                  const std::vector<std::string>& words, const std::string& description);

/// --attributes: names and commas, "all" or "none".
Option add_attributes(CommandLine& app, std::string& list, const std::string& description);

/// The names that --attributes gives, none for "none"; nothing if it is not given.
std::optional<std::vector<std::string>> attribute_names(const std::string& list);

/// --dim: 2 to the largest.
Option add_dimension(CommandLine& app, int& dimension, const std::string& description,
                     int largest = 3);

/// What stands between the separators.
std::vector<std::string_view> split(std::string_view text, char separator);

/// A finite decimal number, like 12, -0.5 or 1e6; nothing for any other text, hexadecimal numbers
/// and such with blanks included.
std::optional<double> parse_number(std::string_view text);

/// Make an option refuse what is no such number: a whole one is of digits only, others are as
/// parse_number() reads them. They return the option.
Option take_whole_number(Option option, std::uint64_t least = 0,
                         std::uint64_t most = std::numeric_limits<std::uint64_t>::max());
Option take_number(Option option);
Option take_positive_number(Option option);
Option take_number_between(Option option, double least, double most);

/// Makes an option refuse what `parse` throws a UsageError for, which says what is wrong with the
/// text but does not name the option. Returns the option.
Option take_parsed(Option option, std::function<void(const std::string& text)> parse);

/// An option of several numbers, separated by commas, above 0 if `positive`.
Option add_number_list(CommandLine& app, const std::string& name, std::vector<double>& values,
                       const std::string& description, bool positive = false);

/// Reads a number of things: digits, or with an exponent (1e6, 2.5e6). Throws UsageError for
/// anything else, negative and fractional numbers included.
std::uint64_t parse_point_count(std::string_view text);

}  // namespace spillway::command
