#include "tools/batch/input_places.h"

#include <spillway/info.h>
#include <spillway/input.h>
#include <spillway/points.h>

#include <cstdint>
#include <filesystem>
#include <optional>
#include <system_error>

#include "src/error.h"
#include "tools/options/command_options.h"
#include "tools/options/input_options.h"

namespace spillway::command {
namespace {

Box<2> plane_of_extent(const std::optional<Extent>& extent) {
  return extent ? plane_of(Box<3>{extent->low, extent->high}) : Box<2>{};
}

std::string value_of(const Job& job, const std::string& option) {
  const auto given = job.options.find(option);
  return given == job.options.end() || given->second.empty() ? "" : given->second.front();
}

void refuse_what_opens_once(const std::string& path) {
  std::error_code unknown;
  if (std::filesystem::is_regular_file(path, unknown)) return;
  throw Failure(path + ": this is no file, so it can be read by one job only, and not twice");
}

}  // namespace

std::vector<InputPlace> places_of(const Job& job, PlaceSurvey how, const Context& context) {
  InputOptions given;
  given.format = value_of(job, "input-format");
  given.table.columns = value_of(job, "columns");
  given.table.separator = value_of(job, "separator");
  given.table.decimal = value_of(job, "decimal");
  given.table.no_header = job.options.contains("no-header");
  if (const auto lines = parse_number(value_of(job, "skip-lines"))) {
    given.table.skip_lines = static_cast<std::uint64_t>(*lines);
  }
  given.crs = value_of(job, "crs");
  given.force_crs = job.options.contains("force-crs");
  given.to_crs = value_of(job, "to-crs");
  given.skip_invalid = job.options.contains("skip-invalid");
  if (const auto most = parse_number(value_of(job, "max-expansion")); most && *most < 1e15) {
    given.max_expansion = static_cast<std::uint64_t>(*most);
  }
  given.salvage = job.options.contains("salvage");
  const PointOptions options = point_options(given, 2);
  const bool distrusts = job.options.contains("no-trust-headers");
  const bool skips = job.options.contains("skip-broken");
  std::vector<InputPlace> places;
  for (const std::string& path : expand_inputs(job.inputs, context)) {
    refuse_what_opens_once(path);
    std::optional<PointsHeader> header;
    try {
      header = spillway::open_points({path}, options, context)->header();
    } catch (const Failure&) {
      if (!skips) throw;
      continue;  // the job itself names it
    }
    if (header->extent && !(distrusts && how == PlaceSurvey::kPoints)) {
      places.push_back({path, plane_of_extent(header->extent), header->count});
    } else if (how == PlaceSurvey::kPoints) {
      const PointsInfo info = spillway::describe_points(path, options, context);
      places.push_back({path, plane_of_extent(info.extent), info.counts.kept()});
    }
  }
  return places;
}

std::string identity(const std::string& path) {
  std::error_code unknown;
  const auto canonical = std::filesystem::canonical(path, unknown);
  return unknown ? path : canonical.string();
}

std::set<std::string> identities(const std::vector<InputPlace>& places) {
  std::set<std::string> names;
  for (const InputPlace& place : places) names.insert(identity(place.path));
  return names;
}

Box<2> widened(Box<2> box, double by) {
  for (std::size_t k = 0; k < 2; ++k) {
    box.lo[k] -= by;
    box.hi[k] += by;
  }
  return box;
}

}  // namespace spillway::command
