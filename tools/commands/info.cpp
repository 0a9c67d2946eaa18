#include <fmt/format.h>
#include <spillway/info.h>
#include <spillway/input.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "src/error.h"
#include "src/geometry/canonical_hash.h"
#include "src/runtime/process_memory.h"
#include "tools/commands/command.h"
#include "tools/commands/run_statistics.h"
#include "tools/options/command_options.h"
#include "tools/options/input_options.h"
#include "tools/process/rank_job.h"
#include "tools/report/json_text.h"
#include "tools/report/printable_text.h"
#include "tools/report/statistics.h"
#include "tools/report/text_output.h"

namespace spillway::command {
namespace {

constexpr const char* kExamples =
    "Examples:\n"
    "  spillway info survey.las\n"
    "  spillway info *.las tin.ply --json | jq .canonical_hash\n"
    "  spillway info --fast 'tiles/*.laz'\n"
    "  spillway generate terrain -n 1e8 | spillway triangulate - -o - | spillway info -\n"
    "All points are read, so extents and counts are exact, whatever headers say; points_outside\n"
    "tells how many lie outside of the box that the header tells. After several files of points\n"
    "comes their total.";

struct InfoOptions {
  const CommandLine* app = nullptr;
  std::vector<std::string> files;
  bool json = false;
  bool fast = false;
  InputOptions input;
  MemoryOptions memory;
  ReportOptions report;
};

Json text_or_null(const std::string& text) { return text.empty() ? Json(nullptr) : Json(text); }

/// Lowest and highest coordinates, the first `coordinates` of them.
Json extent_json(const std::optional<Extent>& extent, int coordinates) {
  if (!extent) return nullptr;
  const auto some = [coordinates](const std::array<double, 3>& corner) {
    return std::vector<double>(corner.begin(), corner.begin() + coordinates);
  };
  return {{"min", some(extent->low)}, {"max", some(extent->high)}};
}

/// Lowest and highest sides, null along open axes.
Json periodic_json(const std::optional<PeriodicBox>& periodic, int dimension) {
  if (!periodic) return nullptr;
  Json low = std::vector<double>();
  Json high = std::vector<double>();
  for (int k = 0; k < dimension; ++k) {
    low.push_back(periodic->periodic[k] ? Json(periodic->box.low[k]) : Json(nullptr));
    high.push_back(periodic->periodic[k] ? Json(periodic->box.high[k]) : Json(nullptr));
  }
  return {{"min", low}, {"max", high}};
}

void add_lattice(const std::optional<LatticeInfo>& lattice, Json& json) {
  json["scale"] = lattice ? Json(lattice->scale) : Json(nullptr);
  json["offset"] = lattice ? Json(lattice->offset) : Json(nullptr);
}

/// Points per square unit of the extent in x, y; null where that has no area.
Json density(const std::optional<Extent>& extent, std::uint64_t points) {
  if (!extent) return nullptr;
  const double area = (extent->high[0] - extent->low[0]) * (extent->high[1] - extent->low[1]);
  return area > 0 ? Json(static_cast<double>(points) / area) : Json(nullptr);
}

/// Members that say nothing are left out: one element, no scale.
Json attribute_json(const Attribute& attribute) {
  Json json;
  json["name"] = attribute.name;
  json["type"] = to_string(attribute.type);
  if (attribute.elements != 1) json["elements"] = attribute.elements;
  if (attribute.scale != 1 || attribute.offset != 0) {
    json["scale"] = attribute.scale;
    json["offset"] = attribute.offset;
  }
  if (!attribute.unit.empty()) json["unit"] = attribute.unit;
  if (!attribute.description.empty()) json["description"] = attribute.description;
  return json;
}

Json attributes_json(const std::vector<Attribute>& attributes,
                     const std::vector<std::array<double, 2>>& ranges = {}) {
  Json json = Json::array();
  for (std::size_t a = 0; a < attributes.size(); ++a) {
    Json attribute = attribute_json(attributes[a]);
    if (!ranges.empty() && !std::isnan(ranges[a][0])) {
      attribute["min"] = ranges[a][0];
      attribute["max"] = ranges[a][1];
    }
    json.push_back(attribute);
  }
  return json;
}

/// {"2": 5000, "6": 300}: of each number that there is, how many points are of it; null without.
Json counts_json(const std::vector<std::uint64_t>& counts) {
  Json json;
  for (std::size_t number = 0; number < counts.size(); ++number) {
    if (counts[number] > 0) json[std::to_string(number)] = counts[number];
  }
  return json;
}

/// {"withheld": 12, "overlap": 0}: how many points have each flag; null without flags.
Json flags_json(const std::vector<std::pair<std::string, std::uint64_t>>& flags) {
  Json json;
  for (const auto& [name, count] : flags) json[name] = count;
  return json;
}

/// How a table of text was understood.
Json table_json(const TableInfo& table) {
  Json json;
  json["separator"] = table.separator;
  json["decimal"] = table.decimal == ',' ? "comma" : "point";
  json["names"] = table.names.empty() ? Json(nullptr) : Json(table.names);
  json["columns"] = Json(table.columns);
  if (!table.characters.empty()) {
    std::vector<std::string> ranges;
    for (const auto& [first, last] : table.characters) {
      ranges.push_back(fmt::format("{}-{}", first, last));
    }
    json["columns"] = Json(ranges);
  }
  json["counts_downwards"] = table.counts_downwards;
  json["first_line"] = table.first_line == 0 ? Json(nullptr) : Json(table.first_line);
  json["first_rows"] = Json(table.first_rows);
  return json;
}

/// The mean distance of neighbours, if points lay on a grid over the extent.
Json spacing(const std::optional<Extent>& extent, std::uint64_t points) {
  const Json per_area = density(extent, points);
  return per_area.is_number() && points > 0 ? Json(1 / std::sqrt(per_area.number()))
                                            : Json(nullptr);
}

/// What several files of points hold together. Files that were told of by their headers alone have
/// the points that these count.
class Total {
 public:
  void add(const PointsInfo& info, bool fast) {
    ++files_;
    points_ += fast ? info.header_points.value_or(0) : info.counts.kept();
    is_known_ = is_known_ && (!fast || info.header_points);
    coordinates_ = std::max(coordinates_, info.coordinates);
    add_counts(info.classes, classes_);
    add_counts(info.returns, returns_);
    for (const auto& [name, count] : info.flags) {
      const auto known =
          std::ranges::find(flags_, name, &std::pair<std::string, std::uint64_t>::first);
      if (known == flags_.end()) {
        flags_.emplace_back(name, count);
      } else {
        known->second += count;
      }
    }
    if (!info.extent) return;
    if (!extent_) extent_ = info.extent;
    for (std::size_t k = 0; k < 3; ++k) {
      extent_->low[k] = std::min(extent_->low[k], info.extent->low[k]);
      extent_->high[k] = std::max(extent_->high[k], info.extent->high[k]);
    }
  }

  [[nodiscard]] std::size_t files() const { return files_; }

  [[nodiscard]] Json json() const {
    Json json;
    json["name"] = "total";
    json["kind"] = "total";
    json["files"] = files_;
    json["points"] = is_known_ ? Json(points_) : Json(nullptr);
    json["extent"] = extent_json(extent_, coordinates_);
    json["density"] = density(extent_, points_);
    json["spacing"] = spacing(extent_, points_);
    json["classes"] = counts_json(classes_);
    json["returns"] = counts_json(returns_);
    json["flags"] = flags_json(flags_);
    return json;
  }

 private:
  static void add_counts(const std::vector<std::uint64_t>& more,
                         std::vector<std::uint64_t>& counts) {
    counts.resize(std::max(counts.size(), more.size()));
    for (std::size_t number = 0; number < more.size(); ++number) counts[number] += more[number];
  }

  std::size_t files_ = 0;
  std::uint64_t points_ = 0;
  bool is_known_ = true;
  int coordinates_ = 2;
  std::optional<Extent> extent_;
  std::vector<std::uint64_t> classes_;
  std::vector<std::uint64_t> returns_;
  std::vector<std::pair<std::string, std::uint64_t>> flags_;
};

/// `fast`: of the header alone.
Json points_json(const std::string& path, const PointsInfo& info, bool filtered, bool fast) {
  const std::uint64_t points = fast ? info.header_points.value_or(0) : info.counts.kept();
  Json json;
  json["name"] = path;
  json["kind"] = "points";
  json["format"] = info.format;
  json["version"] = text_or_null(info.version);
  json["point_format"] = info.point_format < 0 ? Json(nullptr) : Json(info.point_format);
  json["coordinates"] = info.coordinates;
  json["points"] = fast && !info.header_points ? Json(nullptr) : Json(points);
  json["withheld"] = fast ? Json(nullptr) : Json(info.counts.withheld);
  json["lost"] = info.counts.lost;
  json["filters"] = filtered ? to_json(info.counts) : Json(nullptr);
  json["extent"] = extent_json(info.extent, info.coordinates);
  json["header_box"] = extent_json(info.header_box, info.coordinates);
  json["points_outside"] = info.header_box && !fast ? Json(info.points_outside) : Json(nullptr);
  add_lattice(info.lattice, json);
  json["density"] = density(info.extent, points);
  json["spacing"] = spacing(info.extent, points);
  json["crs"] = text_or_null(info.crs);
  json["crs_note"] = text_or_null(info.crs_note);
  json["software"] = text_or_null(info.software);
  if (info.cells) json["cells"] = *info.cells;
  json["classes"] = counts_json(info.classes);
  json["returns"] = counts_json(info.returns);
  json["flags"] = flags_json(info.flags);
  if (info.table) json["table"] = table_json(*info.table);
  json["attributes"] = attributes_json(info.attributes, info.ranges);
  return json;
}

Json mesh_json(const std::string& path, const MeshInfo& info) {
  Json json;
  json["name"] = path;
  json["kind"] = "mesh";
  json["format"] = text_or_null(info.format);
  json["dimension"] = info.dimension;
  json["vertices"] = info.totals.vertices;
  json["simplices"] = info.totals.simplices;
  json["hull_facets"] = info.totals.hull_facets;
  json["canonical_hash"] = hash_to_hex(info.totals.canonical_hash);
  json["extent"] = extent_json(info.extent, 3);
  for (const auto& [least, largest] : info.further_extent) {
    json["extent"]["min"].push_back(least);
    json["extent"]["max"].push_back(largest);
  }
  add_lattice(info.lattice, json);
  json["on_lattice"] = info.lattice.has_value();
  json["periodic"] = periodic_json(info.periodic, info.dimension);
  json["input_index"] = info.has_input_index;
  json["crs"] = text_or_null(info.crs);
  if (info.tells_totals) {
    json["points"] = info.totals.points;
    json["duplicates"] = info.totals.duplicates;
  }
  if (info.peak_live_vertices) json["peak_live_vertices"] = *info.peak_live_vertices;
  json["attributes"] = attributes_json(info.attributes);
  return json;
}

bool is_pipe(const std::string& path) {
  std::error_code ignored;
  const auto status = std::filesystem::status(path, ignored);
  return path == "-" || (std::filesystem::exists(status) && !is_regular_file(status));
}

/// What --input-format names on a pipe is points.
InputKind kind_of(const std::string& path, const InfoOptions& options, const Context& context) {
  const bool told = !options.input.format.empty() && is_pipe(path);
  return told ? InputKind::kPoints : kind_of_input(path, context);
}

Json describe_input(const std::string& path, const InfoOptions& options, const Context& context,
                    Total& total) {
  if (kind_of(path, options, context) == InputKind::kMesh) {
    return mesh_json(path,
                     describe_mesh(path, {.max_expansion = options.input.max_expansion}, context));
  }
  const PointOptions how = point_options(options.input, 2);
  const PointsInfo info =
      options.fast ? describe_header(path, how, context) : describe_points(path, how, context);
  total.add(info, options.fast);
  return points_json(path, info, options.input.filters(), options.fast);
}

std::string value_text(const Json& value) {
  if (value.is_null()) return "-";
  if (value.is_text()) return printable(value.text());
  if (value.is_float()) return fmt::format("{:.15g}", value.number());
  if (!value.is_array()) return json_text(value);
  if (value.elements().empty()) return "-";
  std::string text;
  for (const Json& item : value.elements()) {
    if (!text.empty()) text += "  ";
    text += value_text(item);
  }
  return text;
}

/// "uint16", "float32  elements 3  unit m": what an attribute is besides its name.
std::string attribute_text(const Json& attribute) {
  std::string text;
  for (const auto& [key, value] : attribute.members()) {
    if (key == "name") continue;
    if (key != "type") text += "  " + key + ' ';
    text += value_text(value);
  }
  return text;
}

/// Rows stand each in a line of its own.
std::string table_text(const Json& table) {
  std::string text = "  table\n";
  for (const auto& [key, value] : table.members()) {
    if (key != "first_rows") {
      text += fmt::format("    {:22} {}\n", key, value_text(value));
      continue;
    }
    text += fmt::format("    {}\n", key);
    for (const Json& row : value.elements()) {
      text += fmt::format("      {}\n", printable(row.text()));
    }
  }
  return text;
}

/// The same keys and values as the JSON, laid out for people: no more digits than mean something.
std::string describe(const Json& json) {
  std::string text = printable(json.find("name")->text()) + "\n";
  for (const auto& [key, value] : json.members()) {
    if (key == "name") continue;
    if (value.is_object() && (key == "classes" || key == "returns" || key == "flags")) {
      text += fmt::format("  {}\n", key);
      for (const auto& [number, count] : value.members()) {
        text += fmt::format("    {:22} {}\n", number, value_text(count));
      }
    } else if (key == "table") {
      text += table_text(value);
    } else if (value.is_object()) {
      for (const auto& [inner_key, inner_value] : value.members()) {
        const std::string path = fmt::format("{} {}", key, inner_key);
        text += fmt::format("  {:16} {}\n", path, value_text(inner_value));
      }
    } else if (key == "attributes" && !value.elements().empty()) {
      text += fmt::format("  {}\n", key);
      for (const Json& attribute : value.elements()) {
        text += fmt::format("    {:22} {}\n", value_text(*attribute.find("name")),
                            attribute_text(attribute));
      }
    } else {
      const bool estimate = (key == "density" || key == "spacing") && value.is_number();
      text += fmt::format("  {:16} {}\n", key,
                          estimate ? fmt::format("{:.6g}", value.number()) : value_text(value));
    }
  }
  return text;
}

/// Adds what the JSON of every kind of file has in common with that of --stats; null where the file
/// does not tell.
void add_common_keys(double seconds, Json& json) {
  for (const char* key :
       {"points", "duplicates", "vertices", "simplices", "hull_facets", "canonical_hash"}) {
    if (!json.contains(key)) json[key] = nullptr;
  }
  json["peak_rss_bytes"] = peak_memory();
  json["seconds"] = seconds;
}

Json tell(const std::string& path, const InfoOptions& options, const Context& context,
          Total& total) {
  const auto start = std::chrono::steady_clock::now();
  Json json = describe_input(path, options, context, total);
  if (options.json) {
    add_common_keys(std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count(),
                    json);
  }
  write_text("-", options.json ? json_text(json) + "\n" : describe(json));
  return json;
}

/// Whether an input is points, or cannot be looked at, which is told in its turn.
bool may_be_points(const std::string& path, const InfoOptions& options, const Context& context) {
  try {
    return kind_of(path, options, context) == InputKind::kPoints;
  } catch (const Failure&) {
    return true;
  }
}

/// Throws UsageError if there are options for points, and no points.
void check_point_options(const std::vector<std::string>& paths, const InfoOptions& options,
                         const Context& context) {
  const bool points = std::ranges::any_of(
      paths, [&](const std::string& path) { return may_be_points(path, options, context); });
  if (points) return;
  refuse_given(*options.app, kPointOptionNames,
               paths.size() == 1 ? fmt::format("on {}, which is a mesh", paths.front())
                                 : "on these files, which are meshes");
}

int run(const InfoOptions& options) {
  const auto start = std::chrono::steady_clock::now();
  check_figures_file(options.report, options.files, "-", "the report");
  ProgressLine progress = make_progress(options.report);
  const Context context(context_options(options.memory, 0, progress));
  const std::vector<std::string> paths = expand_inputs(options.files, context);
  if (!given_options(*options.app, kPointOptionNames).empty()) {
    check_point_options(paths, options, context);
  }
  if (options.fast) {
    std::vector<std::string_view> filters(kPointOptionNames.begin(), kPointOptionNames.end());
    std::erase_if(filters, [](std::string_view name) {
      return name == "--input-format" || name == "--columns" || name == "--skip-lines" ||
             name == "--separator" || name == "--decimal" || name == "--no-header";
    });
    refuse_given(*options.app, filters, "with --fast, which reads no points");
  }
  Total total;
  Json files = Json::array();
  int exit_code = kExitDone;
  for (const std::string& path : paths) {
    try {
      files.push_back(tell(path, options, context, total));
    } catch (const InvalidArgument&) {
      throw;
    } catch (const ClosedPipe&) {
      throw;
    } catch (const Failure& error) {
      // What else there is to tell is not held up by one file.
      progress.give_up();
      if (paths.size() == 1) throw;
      exit_code = report_error(error, kExitFailed);
    }
  }
  if (total.files() > 1) {
    write_text("-", options.json ? json_text(total.json()) + "\n" : describe(total.json()));
  }
  write_figures(options.report, {{"files", files}}, start);
  return exit_code;
}

}  // namespace

Subcommand add_info(CommandLine& root) {
  const auto options = std::make_shared<InfoOptions>();
  CommandLine& app = root.add_subcommand("info", "Tell what point files and meshes hold");
  options->app = &app;
  app.set_footer(kExamples);
  app.add_option("FILE", options->files,
                 "Point files and meshes; - is points or a mesh stream from a pipe")
      .required();
  app.add_flag("--json", options->json, "One JSON object a line for each file");
  app.add_flag("--fast", options->fast, "Of points, tell what headers tell, and read no points");
  add_input_options(app, options->input);
  app.remove_option("--crs");
  app.remove_option("--force-crs");    // each file is told of for itself,
  app.remove_option("--skip-broken");  // and one that is broken does not end the run
  add_memory_options(app, options->memory);
  add_report_options(app, options->report);
  return {&app, [options] { return run(*options); }};
}

}  // namespace spillway::command
