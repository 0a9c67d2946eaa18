#include "tools/commands/command.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <memory>
#include <string>
#include <vector>

#include "src/distributed/ranks.h"
#include "tools/options/command_options.h"
#include "tools/options/option_tree.h"
#include "tools/options/suggestion.h"
#include "tools/process/rank_job.h"
#include "tools/process/usage_error.h"
#include "tools/report/standard_error.h"
#include "tools/report/text_output.h"

namespace spillway::detail {
namespace {

constexpr const char* kDescription =
    "Exact, parallel Delaunay triangulation of point clouds. Every result is the one canonical\n"
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

/// Says what is wrong with the command line, and what may have been meant.
UsageError usage_error(const CLI::App& root, const CLI::ParseError& error) {
  const auto parsed = root.get_subcommands();
  std::vector<std::string> names;
  if (parsed.empty()) {
    if (root.remaining().empty()) {
      return UsageError(fmt::format("{} (see `spillway --help`)", error.what()));
    }
    for (const CLI::App* app : subcommands_of(root)) names.push_back(app->get_name());
    const std::string word = root.remaining().front();
    return UsageError(
        fmt::format("'{}' is neither a subcommand nor an option{} (see `spillway "
                    "--help`)",
                    word, suggestion(word, names)));
  }
  const CLI::App& app = *parsed.front();
  for (const OptionInfo& option : options_of(app)) {
    if (!option.positional) names.insert(names.end(), option.names.begin(), option.names.end());
  }
  // An option that there is not may well be the reason why another one seems to be missing.
  for (const std::string& word : root.remaining(true)) {
    if (word.size() < 2 || word.front() != '-') continue;
    const std::string name = word.substr(0, word.find('='));
    if (std::find(names.begin(), names.end(), name) != names.end()) {
      return UsageError(
          fmt::format("{} is an option of {}: give it behind that word", name, app.get_name()));
    }
    const std::string meant = name.starts_with("--") ? suggestion(name, names) : "";
    return UsageError(fmt::format("{} has no option {}{} (see `spillway {} --help`)",
                                  app.get_name(), name, meant, app.get_name()));
  }
  return UsageError(fmt::format("{} (see `spillway {} --help`)", error.what(), app.get_name()));
}

/// Throws UsageError if an option or a positional was given an empty text: "$UNSET" in a script is
/// no way to leave it away.
void refuse_empty_values(const CLI::App& root) {
  for (const CLI::App* app : root.get_subcommands()) {
    for (const CLI::Option* option : app->get_options()) {
      for (const std::string& value : option->results()) {
        if (value.empty()) {
          throw UsageError(fmt::format("{}: the value is empty (see `spillway {} --help`)",
                                       option->get_name(), app->get_name()));
        }
      }
    }
  }
}

/// All options and subcommands.
class CommandTree {
 public:
  CommandTree() {
    root_.formatter(std::make_shared<HelpFormatter>());
    root_.set_help_flag("-h,--help", "Print this help and exit");
    root_.set_version_flag("-V,--version", "spillway " SPILLWAY_VERSION,
                           "Print the version and exit");
    root_.require_subcommand(1);
    root_.footer(kExamples);
    for (const auto add :
         {add_triangulate, add_dem, add_contour, add_render, add_info, add_generate, add_check,
          add_convert, add_batch, add_completion, add_manual}) {
      subcommands_.push_back(add(root_));
    }
  }

  [[nodiscard]] CLI::App& root() { return root_; }

  /// Does what the parsed command line says.
  [[nodiscard]] int run() const {
    for (const Subcommand& subcommand : subcommands_) {
      if (!subcommand.app->parsed()) continue;
      if (distributed::launch().ranks > 1 && !subcommand.over_ranks) {
        throw UsageError(fmt::format("{} is done by one process: start it without mpirun",
                                     subcommand.app->get_name()));
      }
      if (distributed::launch().ranks > 1) {
        check_same_options(subcommand.app->get_name() + '\n' + subcommand.app->config_to_str());
      }
      return subcommand.run();
    }
    throw UsageError("no subcommand given");
  }

 private:
  CLI::App root_{kDescription, "spillway"};
  std::vector<Subcommand> subcommands_;
};

}  // namespace

void check_command_line(const std::vector<std::string>& arguments) {
  CommandTree tree;
  try {
    // CLI11 wants the last one first.
    tree.root().parse(std::vector<std::string>(arguments.rbegin(), arguments.rend()));
  } catch (const CLI::ParseError& error) {
    throw usage_error(tree.root(), error);
  }
  refuse_empty_values(tree.root());
}

int run_command(int argc, const char* const* argv) {
  CommandTree tree;
  CLI::App& root = tree.root();
  // CLI11 wants the last one first.
  std::vector<std::string> words(std::make_reverse_iterator(argv + argc),
                                 std::make_reverse_iterator(argv + std::min(argc, 1)));
  if (argc > 1 && words.back() == "version") words.back() = "--version";
  if (argc > 1 && words.back() == "help") {
    words.pop_back();
    const bool of_itself = !words.empty() && (words.back() == "help" || words.back() == "version");
    if (of_itself) words.pop_back();
    words.insert(words.begin(), "--help");
  }
  if (argc < 2) {
    write_to_standard_error(root.help());
    return kExitUsage;
  }
  try {
    root.parse(words);
  } catch (const CLI::CallForHelp& call) {
    // `spillway nothing --help`: what is not there has no help.
    if (root.get_subcommands().empty() && !root.remaining().empty()) throw usage_error(root, call);
    if (is_first_rank()) write_text("-", root.help());
    return kExitDone;
  } catch (const CLI::CallForVersion&) {
    if (is_first_rank()) write_text("-", root.version() + "\n");
    return kExitDone;
  } catch (const CLI::ParseError& error) {
    throw usage_error(root, error);
  }
  refuse_empty_values(root);
  return tree.run();
}

}  // namespace spillway::detail
