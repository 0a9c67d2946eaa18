#include "tools/options/triangulation_options.h"

#include <fmt/format.h>
#include <malloc.h>
#include <unistd.h>

#include <algorithm>

#include "src/distributed/ranks.h"
#include "src/parallel/parallel.h"
#include "tools/report/usage_error.h"

namespace spillway::command {
namespace {

const std::vector<std::string>& heights_names() {
  static const std::vector<std::string> names = {"first", "lowest", "highest", "mean"};
  return names;
}

/// The choice of that name, which must be one of heights_names().
Heights heights_by_name(const std::string& name) {
  const auto& names = heights_names();
  return static_cast<Heights>(std::ranges::find(names, name) - names.begin());
}

Division division_by_name(const std::string& name) {
  if (name == "longest") return Division::kLongestExtent;
  if (name == "cycling") return Division::kCyclingAxis;
  if (name == "constant") return Division::kConstantAxis;
  return Division::kLeastBorder;
}

}  // namespace

void add_triangulation_options(CommandLine& app, TriangulationOptions& options) {
  options.app = &app;
  add_choice(app, "--heights", options.heights, heights_names(),
             "Which z a vertex of several points of equal x, y gets");
  take_positive_number(app.add_option("--max-edge", options.max_edge,
                                      "Leave out simplices with an edge longer than L"))
      .value_name("L");
  add_input_options(app, options.input);
  take_whole_number(
      app.add_option("--threads", options.threads, "Threads to use; 0: all there are"), 0,
      kMostThreads)
      .value_name("N")
      .group(kResourceGroup)
      .show_default();
  add_memory_options(app, options.memory);
  app.add_option("--resume", options.resume_folder,
                 "Keep the state of the run in this folder; after it was killed, the same command "
                 "goes on from there")
      .value_name("DIR")
      .group(kResourceGroup);
  take_number_between(app.add_option("--checkpoint-every", options.checkpoint_seconds,
                                     "Seconds between two states that --resume keeps"),
                      0, 1e6)
      .value_name("S")
      .group(kResourceGroup)
      .show_default();
  app.add_flag("--no-trust-headers", options.distrust_headers,
               "Read all points before triangulating, as headers may lie about their extent")
      .group(kTuningGroup);
  app.add_option("--tasks", options.tasks_path,
                 "Write the run's tasks, a line of JSON for each tile and merge of tiles")
      .value_name("FILE")
      .group(kTuningGroup);
  take_whole_number(app.add_option("--leaf-points", options.leaf_points,
                                   "Most points of one sequential base case (a leaf); 0: chosen by "
                                   "number and memory"))
      .value_name("N")
      .group(kTuningGroup)
      .show_default();
  take_whole_number(
      app.add_option("--tile-points", options.tile_points,
                     "Most points of a tile that is loaded at a time; 0: chosen by the memory"))
      .value_name("N")
      .group(kTuningGroup)
      .show_default();
  add_choice(app, "--division", options.division,
             {"least-border", "longest", "cycling", "constant"},
             "Which axis the division of points cuts")
      .group(kTuningGroup);
  take_whole_number(
      app.add_option("--children", options.children, "Parts that are merged at a time"), 2, 1024)
      .value_name("K")
      .group(kTuningGroup)
      .show_default();
  add_choice(app, "--kernel", options.kernel, {"spillway", "cgal"},
             "What triangulates base cases; both give the same mesh")
      .group(kTuningGroup);
}

void check_duplicates(const TriangulationOptions& options, int dimension) {
  if (dimension == 2) return;
  refuse_given(
      *options.app, {"--heights"},
      fmt::format("with --dim {}, as it chooses a height for points of equal x and y", dimension));
}

void check_heights(const TriangulationOptions& options, const PointsHeader& points) {
  if (points.coordinates == 3) return;
  refuse_given(*options.app, {"--heights"}, "on points without z");
}

unsigned thread_count(const TriangulationOptions& options) {
  if (options.threads > 0) return options.threads;
  const unsigned available = available_threads();
  // Ranks of one machine share its processors, unless each has been bound to some of its own.
  const bool bound = available < static_cast<unsigned>(::sysconf(_SC_NPROCESSORS_ONLN));
  const auto sharing = static_cast<unsigned>(distributed::launch().ranks_here);
  return bound ? available : std::max(1U, available / sharing);
}

std::optional<double> max_edge(const TriangulationOptions& options) {
  return parse_number(options.max_edge);
}

TriangulateOptions triangulate_options(const TriangulationOptions& options, int dimension) {
  if (options.resume_folder.empty()) {
    refuse_given(*options.app, {"--checkpoint-every"}, "without --resume");
  } else if (!options.tasks_path.empty()) {
    throw UsageError("--tasks has no effect with --resume, as some may be done by another process");
  }
  TriangulateOptions how;
  how.dimension = dimension;
  how.heights = heights_by_name(options.heights);
  how.max_edge = max_edge(options);
  how.tile_points = options.tile_points;
  how.leaf_points = options.leaf_points;
  how.division = division_by_name(options.division);
  how.children = options.children;
  if (options.kernel == "cgal") how.kernel = Kernel::kCgal;
  how.trust_headers = !options.distrust_headers;
  how.resume_folder = options.resume_folder;
  how.checkpoint_seconds = *parse_number(options.checkpoint_seconds);
  return how;
}

void reuse_freed_memory(std::size_t kept) {
  mallopt(M_MMAP_THRESHOLD, static_cast<int>(kept / 4));
  mallopt(M_TRIM_THRESHOLD, static_cast<int>(kept));
  // The allocator's other stores give memory back in spite of that.
  mallopt(M_ARENA_MAX, 1);
}

}  // namespace spillway::command
