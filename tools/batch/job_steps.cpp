#include "tools/batch/job_steps.h"

#include <fmt/format.h>
#include <spillway/dem.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <sstream>
#include <string_view>
#include <utility>

#include "formats/meshes/mesh_formats.h"
#include "formats/vectors/vector_formats.h"
#include "tools/options/input_options.h"
#include "tools/options/triangulation_options.h"
#include "tools/report/usage_error.h"

namespace spillway::command {
namespace {

/// What the first part of a kind like "dem.tif" may be, besides the products of a raster.
constexpr std::array<std::string_view, 3> kSubcommands = {"dem", "contour", "render"};

/// An option that a subcommand cannot do without, unless it has the other one.
struct Needed {
  std::string_view subcommand;
  std::string_view option;
  std::string_view other;
  std::string_view meaning;
};

constexpr std::array kNeeded = {
    Needed{"dem", "resolution", "like", "the side of a pixel"},
    Needed{"contour", "interval", "levels", "the height between two contours"}};

/// Options that a batch shares out among its jobs, or decides for them.
constexpr std::array<std::string_view, 11> kShared = {
    "threads", "memory", "scratch-folder", "max-tmp", "progress",        "quiet",
    "verbose", "output", "stats",          "resume",  "checkpoint-every"};

OutputKind kind_by_name(const Job& job, const std::string& name) {
  const std::size_t dot = name.find('.');
  if (dot == std::string::npos) {
    try {
      mesh_format("x." + name, "");
    } catch (const InvalidArgument&) {
      throw UsageError(
          fmt::format("{}: no output can be made as \"{}\"; a mesh is one of {}, "
                      "anything else is named like dem.tif",
                      job.name, name, fmt::join(mesh_format_names(), ", ")));
    }
    return {"triangulate", {}};
  }
  const std::string first = name.substr(0, dot);
  const bool is_subcommand = std::ranges::find(kSubcommands, first) != kSubcommands.end();
  if (!is_subcommand && !dem_band_of(first)) {
    std::vector<std::string> products = dem_product_names();
    products.back() = "p95";  // for all percentiles
    throw UsageError(
        fmt::format("{}: no output can be made as \"{}\"; before the dot stands one "
                    "of {}, {}",
                    job.name, name, fmt::join(kSubcommands, ", "), fmt::join(products, ", ")));
  }
  const VectorFormat* const format = vector_format_of_path("x." + name);
  const bool is_lonlat = format != nullptr && format->is_lonlat;
  if (is_subcommand) return {first, {}, is_lonlat};
  return {"dem", {"--product", first}, is_lonlat};
}

bool makes_any(const Job& job, std::string_view subcommand) {
  return std::ranges::any_of(job.to, [&](const std::string& name) {
    return kind_by_name(job, name).subcommand == subcommand;
  });
}

bool makes_raster(const Job& job) { return makes_any(job, "dem"); }

/// The filter of points by place, where a raster is made, whose --bounds are its own.
constexpr std::string_view kClip = "clip-bounds";

/// What this filter is called where such an output is made of points.
std::string filter_by_place(const OutputKind& kind) {
  return kind.subcommand == "dem" ? std::string(kClip) : "bounds";
}

std::string text_of(const Box<2>& box) {
  return fmt::format("{},{},{},{}", box.lo[0], box.lo[1], box.hi[0], box.hi[1]);
}

/// What a filter by place leaves of a box that it meets.
std::string common_text(const std::string& filter, const Box<2>& box) {
  const Extent given = parse_bounds(filter);
  const Box<2> common = common_part(plane_of(Box<3>{given.low, given.high}), box);
  if (std::isinf(given.low[2])) return text_of(common);
  return fmt::format("{},{},{},{},{},{}", common.lo[0], common.lo[1], given.low[2], common.hi[0],
                     common.hi[1], given.high[2]);
}

/// The value of --product with which a raster of this kind is made.
std::string products_of(const OutputKind& kind, const Job& job) {
  if (!kind.arguments.empty()) return kind.arguments.back();
  const auto given = job.options.find("product");
  return given == job.options.end() ? "height" : fmt::format("{}", fmt::join(given->second, ","));
}

/// Options of a raster that only such products use.
constexpr std::array<std::pair<std::string_view, bool DemProductTraits::*>, 6> kTraitOfOption = {
    {{"azimuth", &DemProductTraits::by_azimuth},
     {"altitude", &DemProductTraits::by_altitude},
     {"z-factor", &DemProductTraits::by_ground},
     {"gradient", &DemProductTraits::by_gradient},
     {"compute-edges", &DemProductTraits::of_neighbours},
     {"fill-voids", &DemProductTraits::fills_voids}}};

/// Of products with commas between them; unknown ones are left to the subcommand.
std::vector<DemProductTraits> traits_of_list(const std::string& products) {
  std::vector<DemProductTraits> traits;
  std::istringstream words(products);
  for (std::string name; std::getline(words, name, ',');) {
    if (const auto band = dem_band_of(name)) traits.push_back(traits_of(band->product));
  }
  return traits;
}

/// Whether it is of no use where nothing is triangulated.
bool is_of_triangles(const std::string& name) {
  return name == "max-edge" ||
         (name != "no-trust-headers" && std::ranges::find(kTriangulationOptionNames, "--" + name) !=
                                            kTriangulationOptionNames.end());
}

bool has_any(const std::vector<DemProductTraits>& traits, bool DemProductTraits::*trait) {
  return std::ranges::any_of(traits, trait);
}

/// Whether an output is made of points, for which no mesh will do.
bool needs_points(const Job& job, const std::string& name) {
  const OutputKind kind = kind_by_name(job, name);
  return kind.subcommand == "dem" &&
         has_any(traits_of_list(products_of(kind, job)), &DemProductTraits::of_points);
}

bool has_value(const Job& job, const std::string& option, const std::string& value) {
  const auto given = job.options.find(option);
  return given != job.options.end() && std::ranges::count(given->second, value) > 0;
}

/// A path as the parser takes it for one: not for an option or a list, whatever it begins with.
std::string path_argument(const std::string& path) {
  const bool misleading = path.find_first_of("-[{") == 0;
  return misleading ? "./" + path : path;
}

/// What all other outputs of a job are made of.
std::string stream_kind() { return std::string(own_mesh_stream().name); }

}  // namespace

bool has_seams(const Job& job) { return makes_raster(job) || makes_any(job, "contour"); }

Box<2> wanted_place(const Job& job) {
  const auto filter = job.options.find(makes_raster(job) ? std::string(kClip) : "bounds");
  if (filter == job.options.end()) return whole_space<2>();
  const Extent box = parse_bounds(filter->second.front());
  return plane_of(Box<3>{box.low, box.high});
}

const std::vector<std::string>& job_subcommands() {
  static const std::vector<std::string> names = {"triangulate", "dem", "contour", "render"};
  return names;
}

JobPlanner::JobPlanner(const CommandLine& root, std::string folder, std::string scratch)
    : root_(root), folder_(std::move(folder)), scratch_(std::move(scratch)) {}

bool JobPlanner::has_option(const std::string& subcommand, const std::string& name) const {
  if (name == "help") return false;  // no output comes of it
  return root_.subcommand(subcommand).has_option("--" + name);
}

std::vector<JobStep> JobPlanner::plan(const Job& job) const {
  std::vector<JobStep> steps;
  std::vector<std::string> kinds = job.to;
  for (auto kind = kinds.begin(); kind != kinds.end(); ++kind) {
    if (std::find(kinds.begin(), kind, *kind) == kind) continue;
    throw UsageError(fmt::format("{}: the output {} appears twice", job.name, *kind));
  }
  const auto of_mesh = std::ranges::stable_partition(
      kinds, [&](const std::string& kind) { return needs_points(job, kind); });
  std::vector<std::string> of_points(kinds.begin(), of_mesh.begin());
  kinds.erase(kinds.begin(), of_mesh.begin());
  if (kinds.size() == 1) of_points.push_back(std::exchange(kinds, {}).front());
  for (const std::string& kind : of_points) steps.push_back(step(job, kind, job.inputs, true));
  if (!kinds.empty()) {
    const auto stream = std::find(kinds.begin(), kinds.end(), stream_kind());
    JobStep first = step(job, stream_kind(), job.inputs, true);
    if (stream != kinds.end()) {
      kinds.erase(stream);
    } else {
      first.temporary = true;
      first.output = path_argument(
          (std::filesystem::path(scratch_) / (job.name + "." + stream_kind())).string());
      first.arguments[first.arguments.size() - 1] = first.output;
    }
    steps.push_back(first);
    for (const std::string& kind : kinds) {
      steps.push_back(step(job, kind, {first.output}, false));
    }
  }
  check_options(job, steps);
  return steps;
}

/// The output comes last, after -o.
JobStep JobPlanner::step(const Job& job, const std::string& kind_name,
                         const std::vector<std::string>& inputs, bool of_points) const {
  OutputKind kind = kind_by_name(job, kind_name);
  if (!of_points && kind.subcommand == "triangulate") kind.subcommand = "convert";
  JobStep step;
  step.arguments = {kind.subcommand};
  for (const std::string& input : inputs) step.arguments.push_back(path_argument(input));
  step.arguments.insert(step.arguments.end(), kind.arguments.begin(), kind.arguments.end());
  for (const auto& [name, values] : options_of_step(job, kind, of_points, step.options)) {
    if (values.empty()) step.arguments.push_back("--" + name);
    for (const std::string& value : values) {
      step.arguments.push_back(fmt::format("--{}={}", name, value));
    }
  }
  step.output =
      path_argument((std::filesystem::path(folder_) / (job.name + "." + kind_name)).string());
  step.arguments.insert(step.arguments.end(), {"-o", step.output});
  return step;
}

/// The options of one step; `taken` gets the names of the job's own among them.
JobOptions JobPlanner::options_of_step(const Job& job, const OutputKind& kind, bool of_points,
                                       std::vector<std::string>& taken) const {
  const bool is_raster = kind.subcommand == "dem";
  JobOptions options;
  for (const auto& [name, values] : job.options) {
    if (!takes_option(job, kind, of_points, name)) continue;
    taken.push_back(name);
    options[name == kClip ? filter_by_place(kind) : name] = values;
  }
  if (!job.area) return options;
  if (of_points) {
    std::vector<std::string>& filter = options[filter_by_place(kind)];
    filter = {filter.empty() ? text_of(job.area->points)
                             : common_text(filter.front(), job.area->points)};
  }
  if (is_raster && !options.contains("bounds")) {
    options["bounds"] = {text_of(job.area->raster)};
    options["align"] = {};
  }
  return options;
}

/// Whether an option of a job has an effect on this step. What triangulate has concerns the points,
/// and is nothing for a step that begins with a mesh, but that --force-crs is about --like and
/// GeoJSON, too.
/// Where a job makes a raster, --bounds and --resolution are the raster's, whatever else it makes:
/// they do not change the triangulation then.
bool JobPlanner::takes_option(const Job& job, const OutputKind& kind, bool of_points,
                              const std::string& name) const {
  const std::string& subcommand = kind.subcommand;
  if (name == kClip) return of_points && makes_raster(job);
  if (!has_option(subcommand, name)) return false;
  const bool clips_pixels = subcommand == "dem" && job.options.contains("clip-pixels");
  if (name == "force-crs" && (kind.is_lonlat || clips_pixels)) return true;
  if (name == "clip" || name == "clip-buffer" || name == "clip-outside") {
    if (clips_pixels) return true;
    const bool clips_points =
        !job.options.contains("clip-pixels") || job.options.contains("clip-simplices");
    return of_points && clips_points;
  }
  if (subcommand == "dem") {
    const std::string products = products_of(kind, job);
    if (name == "product") return kind.arguments.empty();
    const std::vector<DemProductTraits> traits = traits_of_list(products);
    for (const auto& [option, trait] : kTraitOfOption) {
      if (name == option) return has_any(traits, trait);
    }
    const bool all_shades = std::ranges::all_of(traits, &DemProductTraits::by_altitude);
    if (name == "type") return all_shades;
    if (name == "nodata" && all_shades && has_value(job, "type", "byte")) return false;
    if (name == "force-crs" && job.options.contains("like")) return true;
    const bool needs_triangles = traits.empty() || job.options.contains("fill-voids") ||
                                 !std::ranges::all_of(traits, &DemProductTraits::of_points);
    if (!needs_triangles && is_of_triangles(name)) return false;
    if (products == "density" && (name == "max-edge" || name == "heights")) return false;
  }
  if (makes_raster(job) && (name == "bounds" || name == "resolution")) return subcommand == "dem";
  return of_points || !has_option("triangulate", name);
}

void JobPlanner::check_options(const Job& job, const std::vector<JobStep>& steps) const {
  for (const JobStep& step : steps) {
    for (const Needed& needed : kNeeded) {
      if (needed.subcommand != step.arguments.front() ||
          job.options.contains(std::string(needed.option)) ||
          job.options.contains(std::string(needed.other))) {
        continue;
      }
      throw UsageError(fmt::format("{}: --{}, {}, is missing (or --{})", step.output, needed.option,
                                   needed.meaning, needed.other));
    }
  }
  if (job.buffer.value_or(0) > 0 && makes_raster(job)) {
    for (const char* const other : {"like", "force-size"}) {
      if (!job.options.contains(other)) continue;
      throw UsageError(
          fmt::format("{}: --{} says what a raster covers, which --buffer does, too: give one of "
                      "them",
                      job.name, other));
    }
  }
  for (const auto& [name, values] : job.options) {
    if (std::find(kShared.begin(), kShared.end(), name) != kShared.end()) {
      throw UsageError(fmt::format("{}: --{} is for all jobs together: give it to batch itself",
                                   job.name, name));
    }
    const bool used = std::ranges::any_of(steps, [&, &name = name](const JobStep& step) {
      return std::ranges::find(step.options, name) != step.options.end();
    });
    if (!used) {
      throw UsageError(fmt::format("{}: none of its outputs uses the option --{}", job.name, name));
    }
    // The parser would take the next argument for it.
    const bool wants_value =
        std::ranges::any_of(job_subcommands(), [&, &name = name](const std::string& subcommand) {
          return has_option(subcommand, name) &&
                 root_.subcommand(subcommand).takes_value("--" + name);
        });
    const bool empty = std::find(values.begin(), values.end(), "") != values.end();
    if (empty || (wants_value && values.empty())) {
      throw UsageError(
          fmt::format("{}: --{} has no value: give one, or leave it out", job.name, name));
    }
  }
}

}  // namespace spillway::command
