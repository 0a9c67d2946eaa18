#include "tools/commands/command.h"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "src/distributed/ranks.h"
#include "tools/options/command_line.h"
#include "tools/options/former_names.h"
#include "tools/options/suggestion.h"
#include "tools/process/program_pages.h"
#include "tools/process/rank_job.h"
#include "tools/report/standard_error.h"
#include "tools/report/text_output.h"
#include "tools/report/usage_error.h"

namespace spillway::command {
namespace {

constexpr const char* kDescription =
    "Exact, parallel Delaunay triangulation of point clouds. Every result is the one canonical "
    "triangulation of its points, whatever the number of threads or the order of the work.";

constexpr const char* kExamples =
    "Examples:\n"
    "  spillway triangulate survey.las -o tin.ply     a surface mesh of a LiDAR file\n"
    "  spillway dem survey.las -o dem.tif --resolution 0.5  a raster of its heights\n"
    "  spillway render survey.las -o view.png         a picture of it\n"
    "  spillway check tin.ply --points survey.las     prove that it is the Delaunay triangulation\n"
    "  spillway info survey.las tin.ply               what the files hold\n"
    "  spillway convert tin.spm -o tin.ply            another format\n"
    "  spillway generate terrain -n 1e6 -o hills.las  points to try things with\n"
    "`-` is standard input or output. `spillway SUBCOMMAND --help` tells more.";

/// The version, and on a line of its own what this build lacks.
std::string version_text() {
  constexpr const char* kLacks = SPILLWAY_LACKS;
  return fmt::format("spillway " SPILLWAY_VERSION "{}{}", *kLacks == '\0' ? "" : "\n", kLacks);
}

/// Says what is wrong with the command line, and what may have been meant.
UsageError usage_error(const CommandLine& root, const std::string& wrong) {
  const CommandLine* const given = root.given_subcommand();
  std::vector<std::string> names;
  if (given == nullptr) {
    const std::vector<std::string> unknown = root.unknown_arguments();
    if (unknown.empty()) {
      return UsageError(fmt::format("{} (see `spillway --help`)", wrong));
    }
    for (const CommandLine* app : root.subcommands()) names.push_back(app->name());
    const std::string& word = unknown.front();
    return UsageError(
        fmt::format("'{}' is neither a subcommand nor an option{} (see `spillway "
                    "--help`)",
                    word, suggestion(word, names)));
  }
  const CommandLine& app = *given;
  for (const OptionInfo& option : app.options()) {
    if (!option.positional) names.insert(names.end(), option.names.begin(), option.names.end());
  }
  // An option that there is not may well be the reason why another one seems to be missing.
  for (const std::string& word : root.unknown_arguments(true)) {
    if (word.size() < 2 || word.front() != '-') continue;
    const std::string name = word.substr(0, word.find('='));
    if (std::find(names.begin(), names.end(), name) != names.end()) {
      return UsageError(
          fmt::format("{} is an option of {}: give it after that word", name, app.name()));
    }
    const std::string meant = name.starts_with("--") ? suggestion(name, names) : "";
    return UsageError(fmt::format("{} has no option {}{} (see `spillway {} --help`)", app.name(),
                                  name, meant, app.name()));
  }
  return UsageError(fmt::format("{} (see `spillway {} --help`)", wrong, app.name()));
}

/// Throws UsageError if an option or a positional was given an empty text: "$UNSET" in a script is
/// no way to leave it out.
void refuse_empty_values(const CommandLine& root) {
  const CommandLine* const app = root.given_subcommand();
  if (app == nullptr) return;
  for (const GivenOption& option : app->given_options()) {
    for (const std::string& value : option.values) {
      if (value.empty()) {
        throw UsageError(fmt::format("{}: the value is empty (see `spillway {} --help`)",
                                     option.name, app->name()));
      }
    }
  }
}

/// All options and subcommands.
class CommandTree {
 public:
  explicit CommandTree(std::span<const AddSubcommand> table) {
    root_.set_footer(kExamples);
    for (const AddSubcommand& subcommand : table) subcommands_.push_back(subcommand.add(root_));
  }

  [[nodiscard]] CommandLine& root() { return root_; }

  /// Does what the parsed command line says.
  [[nodiscard]] int run() const {
    for (const Subcommand& subcommand : subcommands_) {
      if (subcommand.app != root_.given_subcommand()) continue;
      if (distributed::launch().ranks > 1 && !subcommand.over_ranks) {
        throw UsageError(fmt::format("{} is done by one process: start it without mpirun",
                                     subcommand.app->name()));
      }
      if (distributed::launch().ranks > 1) {
        check_same_options(subcommand.app->name() + '\n' + subcommand.app->given_text());
      }
      return subcommand.run();
    }
    throw UsageError("no subcommand given");
  }

 private:
  CommandLine root_{"spillway", kDescription, version_text()};
  std::vector<Subcommand> subcommands_;
};

/// Of the subcommand that the first word names alone, as options of others take memory all along;
/// of all of them where that needs others, or there is none.
std::unique_ptr<CommandTree> tree_for(const std::string& word,
                                      std::span<const AddSubcommand> table) {
  const auto given = std::ranges::find(table, std::string_view(word), &AddSubcommand::name);
  const bool stands_alone = given != table.end() && !given->needs_others;
  return std::make_unique<CommandTree>(stands_alone ? std::span(&*given, 1) : table);
}

/// What is wrong with these words, as seen with all subcommands.
UsageError error_of(const std::vector<std::string>& words, std::span<const AddSubcommand> table) {
  CommandTree tree(table);
  try {
    tree.root().parse(with_present_names(words));
  } catch (const ArgumentError& error) {
    return usage_error(tree.root(), error.what());
  }
  return usage_error(tree.root(), "");
}

}  // namespace

void check_command_line(const std::vector<std::string>& arguments) {
  CommandTree tree(subcommands());
  try {
    tree.root().parse(with_present_names(arguments));
  } catch (const ArgumentError& error) {
    throw usage_error(tree.root(), error.what());
  }
  refuse_empty_values(tree.root());
}

int run_command(int argc, const char* const* argv, std::span<const AddSubcommand> table) {
  std::vector<std::string> words(argv + std::min(argc, 1), argv + argc);
  if (words.empty()) {
    write_to_standard_error(CommandTree(table).root().help());
    return kExitUsage;
  }
  if (words.front() == "version") words.front() = "--version";
  if (words.front() == "help") {
    words.erase(words.begin());
    const bool of_itself =
        !words.empty() && (words.front() == "help" || words.front() == "version");
    if (of_itself) words.erase(words.begin());
    words.emplace_back("--help");
  }
  const std::unique_ptr<CommandTree> tree = tree_for(words.front(), table);
  CommandLine& root = tree->root();
  Request request{};
  try {
    request = root.parse(with_present_names(words));
  } catch (const ArgumentError&) {
    throw error_of(words, table);
  }
  switch (request) {
    case Request::kHelp:
      // `spillway nothing --help`: what is not there has no help.
      if (root.given_subcommand() == nullptr && !root.unknown_arguments().empty()) {
        throw usage_error(root, "");
      }
      if (is_first_rank()) write_text("-", root.help());
      return kExitDone;
    case Request::kVersion:
      if (is_first_rank()) write_text("-", root.version() + "\n");
      return kExitDone;
    case Request::kRun:
      break;
  }
  refuse_empty_values(root);
  let_go_of_program_pages();
  return tree->run();
}

}  // namespace spillway::command
