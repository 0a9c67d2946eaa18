#include "tools/command.h"

#include <fmt/format.h>

#include <memory>
#include <string>
#include <vector>

#include "src/error.h"
#include "tools/command_options.h"
#include "tools/text_output.h"

namespace spillway {
namespace {

constexpr const char* kDescription =
    "Exact, parallel Delaunay triangulation of point clouds. Every result is the one canonical\n"
    "triangulation of its points, whatever the number of threads or the order of the work.";

constexpr const char* kExamples =
    "Examples:\n"
    "  spillway triangulate survey.las -o tin.ply     a surface mesh of a LiDAR file\n"
    "  spillway check tin.ply --points survey.las     prove that it is the Delaunay triangulation\n"
    "  spillway info survey.las tin.ply               what the files hold\n"
    "  spillway convert tin.spm -o tin.ply            another format\n"
    "  spillway generate terrain -n 1e6 -o hills.las  points to try things with\n"
    "`-` is standard input or output. `spillway SUBCOMMAND --help` tells more.";

}  // namespace

int run_command(int argc, const char* const* argv) {
  CLI::App root(kDescription, "spillway");
  root.formatter(std::make_shared<HelpFormatter>());
  root.set_help_flag("-h,--help", "Print this help and exit");
  root.set_version_flag("--version", "spillway " SPILLWAY_VERSION, "Print the version and exit");
  root.require_subcommand(1);
  root.footer(kExamples);
  const std::vector<Subcommand> subcommands = {
      add_triangulate(root), add_info(root),       add_generate(root), add_check(root),
      add_convert(root),     add_completion(root), add_manual(root)};
  try {
    root.parse(argc, argv);
  } catch (const CLI::CallForHelp&) {
    write_text("-", root.help());
    return kExitDone;
  } catch (const CLI::CallForVersion&) {
    write_text("-", root.version() + "\n");
    return kExitDone;
  } catch (const CLI::ParseError& error) {
    const auto parsed = root.get_subcommands();
    if (parsed.empty() && !root.remaining().empty()) {
      throw UsageError(
          fmt::format("'{}' is neither a subcommand nor an option (see `spillway --help`)",
                      root.remaining().front()));
    }
    throw UsageError(fmt::format("{} (see `spillway {}--help`)", error.what(),
                                 parsed.empty() ? "" : parsed.front()->get_name() + " "));
  }
  for (const Subcommand& subcommand : subcommands) {
    if (subcommand.app->parsed()) return subcommand.run();
  }
  throw UsageError("no subcommand given");
}

}  // namespace spillway
