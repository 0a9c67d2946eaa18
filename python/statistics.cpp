#include "python/statistics.h"

#include <fmt/format.h>
#include <pybind11/stl.h>

#include <string>

#include "python/run.h"

namespace spillway::python {
namespace {

namespace py = pybind11;
using py::literals::operator""_a;

py::dict stages(const RunStatistics& run) {
  py::dict seconds;
  for (const StageSeconds& stage : run.stages) {
    seconds[py::str(std::string(stage.stage))] = stage.seconds;
  }
  return seconds;
}

void add_mesh(const Report& report, py::dict& statistics) {
  const MeshTotals& mesh = report.mesh;
  statistics["dimension"] = report.dimension;
  statistics["points"] = mesh.points;
  statistics["duplicates"] = mesh.duplicates;
  statistics["vertices"] = mesh.vertices;
  statistics["simplices"] = mesh.simplices;
  statistics["hull_facets"] = mesh.hull_facets;
  statistics["canonical_hash"] = hash_text(mesh.canonical_hash);
  statistics["left_out"] = report.left_out;
  statistics["on_lattice"] = report.on_lattice;
  statistics["filters"] = statistics_of(report.points);
  statistics["skipped_files"] = statistics_of(report.skipped_files);
  statistics["lost"] = report.lost;
  statistics["output_format"] = report.output_format;
  statistics["output_bytes"] = report.output_bytes;
  statistics["output_files"] = report.output_files;
  statistics["outside_tiles"] = report.outside_tiles;
  statistics["outside_vertices"] = report.outside_vertices;
  statistics["other_files"] = report.other_files;
}

void add_work(const Report& report, py::dict& statistics) {
  statistics["threads"] = report.threads;
  statistics["tiles"] = report.tiles;
  statistics["tile_capacity"] = report.tile_points;
  statistics["leaves"] = report.leaves;
  statistics["leaf_size"] = report.leaf_points;
  statistics["spilled_points"] = report.spilled_points;
  statistics["spilled_bytes"] = report.spilled_bytes;
  statistics["divided_points"] = report.divided_points;
  statistics["first_block_read_points"] = report.first_block_read_points;
  statistics["tile_shapes"] = py::dict("up_to_twice"_a = report.tile_shapes.up_to_twice,
                                       "up_to_4_times"_a = report.tile_shapes.up_to_4_times,
                                       "longer"_a = report.tile_shapes.longer);
  statistics["final"] =
      py::dict("in_leaves"_a = report.final_in_leaves, "in_tiles"_a = report.final_in_tiles,
               "by_level"_a = report.final_by_level);
  statistics["retriangulated_points"] = report.retriangulated;
  statistics["border_simplices"] = report.border_simplices;
  statistics["border_bytes"] = report.border_bytes;
  statistics["phases"] =
      py::dict("read"_a = report.read_seconds, "divide"_a = report.divide_seconds,
               "triangulate"_a = report.triangulate_seconds, "write"_a = report.write_seconds);
  statistics["stages"] = stages(report);
}

}  // namespace

py::dict statistics_of(const Report& report, const Run& run) {
  py::dict statistics;
  add_mesh(report, statistics);
  add_work(report, statistics);
  statistics["memory_limit"] = run.context().memory();
  statistics["seconds"] = run.seconds();
  return statistics;
}

py::dict statistics_of(const PointCounts& counts) {
  return py::dict("read"_a = counts.read, "invalid"_a = counts.invalid,
                  "withheld"_a = counts.withheld, "lost"_a = counts.lost,
                  "every"_a = counts.skipped, "class"_a = counts.classes,
                  "returns"_a = counts.returns, "bounds"_a = counts.bounds, "clip"_a = counts.clip,
                  "where"_a = counts.where, "thinned"_a = counts.thinned, "kept"_a = counts.kept());
}

py::list statistics_of(const std::vector<SkippedFile>& files) {
  py::list statistics;
  for (const SkippedFile& file : files) {
    statistics.append(py::dict("path"_a = file.path, "message"_a = file.message));
  }
  return statistics;
}

py::list statistics_of(const std::vector<Attribute>& attributes) {
  py::list all;
  for (const Attribute& attribute : attributes) {
    py::dict statistics;
    statistics["name"] = attribute.name;
    statistics["type"] = to_string(attribute.type);
    if (attribute.elements != 1) statistics["elements"] = attribute.elements;
    if (attribute.scale != 1 || attribute.offset != 0) {
      statistics["scale"] = attribute.scale;
      statistics["offset"] = attribute.offset;
    }
    if (!attribute.unit.empty()) statistics["unit"] = attribute.unit;
    if (!attribute.description.empty()) statistics["description"] = attribute.description;
    all.append(statistics);
  }
  return all;
}

py::object extent_of(const std::optional<Extent>& extent,
                     std::span<const std::array<double, 2>> further) {
  if (!extent) return py::none();
  py::object low = triple_of(extent->low);
  py::object high = triple_of(extent->high);
  for (const auto& [least, largest] : further) {
    low = low + py::make_tuple(least);
    high = high + py::make_tuple(largest);
  }
  return py::make_tuple(low, high);
}

py::tuple triple_of(const std::array<double, 3>& axes) {
  return py::make_tuple(axes[0], axes[1], axes[2]);
}

std::string hash_text(std::uint64_t hash) { return fmt::format("{:016x}", hash); }

}  // namespace spillway::python
