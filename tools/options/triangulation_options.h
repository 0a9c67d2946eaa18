#pragma once
// What subcommands that triangulate points have in common.

#include <spillway/triangulate.h>

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "tools/options/command_line.h"
#include "tools/options/command_options.h"
#include "tools/options/input_options.h"

namespace spillway::command {

/// As on the command line.
struct TriangulationOptions {
  const CommandLine* app = nullptr;  ///< the subcommand
  std::vector<std::string> inputs;
  InputOptions input;
  std::string heights = "first";
  std::string max_edge;
  unsigned threads = 0;
  MemoryOptions memory;
  bool distrust_headers = false;
  std::string tasks_path;
  std::size_t leaf_points = 0;
  std::size_t tile_points = 0;
  std::string division = "least-border";
  unsigned children = 2;
  std::string kernel = "spillway";
  std::string resume_folder;
  std::string checkpoint_seconds = "60";
  ReportOptions report;
};

/// All but IN and those of ReportOptions: --heights, --max-edge, the input's, --threads, the
/// memory's, --no-trust-headers, --stats, --tasks, and how the work is divided.
void add_triangulation_options(CommandLine& app, TriangulationOptions& options);

/// Of these the names of those that have no effect where a mesh is read, beside those of
/// add_input_options().
inline constexpr std::array<std::string_view, 10> kTriangulationOptionNames = {
    "--heights",  "--no-trust-headers", "--tasks",  "--leaf-points", "--tile-points",
    "--division", "--children",         "--kernel", "--resume",      "--checkpoint-every"};

/// Throws UsageError if --heights is given, though points of equal x and y are no duplicates:
/// in three dimensions.
void check_duplicates(const TriangulationOptions& options, int dimension);

/// Throws UsageError if --heights is given for points without heights.
void check_heights(const TriangulationOptions& options, const PointsHeader& points);

/// The number of threads that --threads asks for.
unsigned thread_count(const TriangulationOptions& options);

/// The length that --max-edge gives; nothing if it is not given.
std::optional<double> max_edge(const TriangulationOptions& options);

/// The same for triangulate().
TriangulateOptions triangulate_options(const TriangulationOptions& options, int dimension);

/// Buffers of some megabytes come and go with every leaf: taken from the system anew each time,
/// they would cost a fifth of the run in page faults. So much memory stays with the process, in
/// pieces of up to a quarter of it, in one store for all threads.
void reuse_freed_memory(std::size_t kept = std::size_t{16} << 20);

}  // namespace spillway::command
