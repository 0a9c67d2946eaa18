// A product and its subcommand in one file: what docs/architecture.md says of adding one.

#include <fmt/format.h>
#include <spillway/product.h>

#include <cmath>
#include <memory>

#include "tools/commands/command.h"
#include "tools/commands/terrain_input.h"
#include "tools/options/command_options.h"
#include "tools/process/rank_job.h"
#include "tools/report/text_output.h"

namespace spillway::test {
namespace {

/// The mean slope of a terrain, weighed by area.
struct MeanSlope {
  double weighed = 0;
  double area = 0;
  std::uint64_t triangles = 0;
  std::uint64_t vertices = 0;

  void add(const SimplexBlock& block) {
    for (std::size_t c = 0; c < block.corners.size(); c += 3) {
      const auto side = [&](std::size_t corner, int axis) {
        return block.vertices[block.corners[c + corner]][axis] -
               block.vertices[block.corners[c]][axis];
      };
      const double x = side(1, 1) * side(2, 2) - side(1, 2) * side(2, 1);
      const double y = side(1, 2) * side(2, 0) - side(1, 0) * side(2, 2);
      weighed += std::hypot(x, y);
      area += side(1, 0) * side(2, 1) - side(1, 1) * side(2, 0);
    }
    triangles += block.corners.size() / 3;
  }
  void add_vertices(std::span<const Point<3>> some) { vertices += some.size(); }
  void combine(const MeanSlope& other) {
    weighed += other.weighed;
    area += other.area;
    triangles += other.triangles;
    vertices += other.vertices;
  }
};

int run(const TerrainOptions& options) {
  ProgressLine progress = make_progress(options.report);
  const Context context = terrain_context(options, progress);
  Product<MeanSlope> product(context);
  (void)send_terrain(options, product.sink(), context);
  if (!is_first_rank()) return kExitDone;
  const MeanSlope& slope = product.result();
  write_text("-", fmt::format("{} triangles, {} vertices, mean slope {:.9f}\n", slope.triangles,
                              slope.vertices, slope.weighed / slope.area));
  return kExitDone;
}

}  // namespace

Subcommand add_mean_slope(CommandLine& root) {
  const auto options = std::make_shared<TerrainOptions>();
  CommandLine& app = root.add_subcommand("mean-slope", "Tell the mean slope of a terrain");
  add_terrain_options(app, *options);
  add_report_options(app, options->report);
  return {&app, [options] { return run(*options); }, true};
}

}  // namespace spillway::test
