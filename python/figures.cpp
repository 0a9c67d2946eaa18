#include "python/figures.h"

#include <fmt/format.h>
#include <pybind11/stl.h>

#include <string>

#include "python/run.h"

namespace spillway::python {
namespace {

namespace py = pybind11;
using py::literals::operator""_a;

py::dict stages(const RunFigures& run) {
  py::dict seconds;
  for (const StageSeconds& stage : run.stages) {
    seconds[py::str(std::string(stage.stage))] = stage.seconds;
  }
  return seconds;
}

void add_mesh(const Report& report, py::dict& figures) {
  const MeshTotals& mesh = report.mesh;
  figures["dimension"] = report.dimension;
  figures["points"] = mesh.points;
  figures["duplicates"] = mesh.duplicates;
  figures["vertices"] = mesh.vertices;
  figures["simplices"] = mesh.simplices;
  figures["hull_facets"] = mesh.hull_facets;
  figures["canonical_hash"] = hash_text(mesh.canonical_hash);
  figures["left_out"] = report.left_out;
  figures["on_lattice"] = report.on_lattice;
  figures["filters"] = figures_of(report.points);
  figures["skipped_files"] = figures_of(report.skipped_files);
  figures["lost"] = report.lost;
  figures["output_format"] = report.output_format;
  figures["output_bytes"] = report.output_bytes;
}

void add_work(const Report& report, py::dict& figures) {
  figures["threads"] = report.threads;
  figures["tiles"] = report.tiles;
  figures["tile_capacity"] = report.tile_capacity;
  figures["leaves"] = report.leaves;
  figures["leaf_size"] = report.leaf_size;
  figures["spilled_points"] = report.spilled_points;
  figures["spilled_bytes"] = report.spilled_bytes;
  figures["divided_points"] = report.divided_points;
  figures["first_block_read_points"] = report.first_block_read_points;
  figures["tile_shapes"] = py::dict("up_to_twice"_a = report.tile_shapes.up_to_twice,
                                    "up_to_4_times"_a = report.tile_shapes.up_to_4_times,
                                    "longer"_a = report.tile_shapes.longer);
  figures["final"] =
      py::dict("in_leaves"_a = report.final_in_leaves, "in_tiles"_a = report.final_in_tiles,
               "by_level"_a = report.final_by_level);
  figures["retriangulated_points"] = report.retriangulated;
  figures["border_simplices"] = report.border_simplices;
  figures["border_bytes"] = report.border_bytes;
  figures["phases"] =
      py::dict("read"_a = report.read_seconds, "divide"_a = report.divide_seconds,
               "triangulate"_a = report.triangulate_seconds, "write"_a = report.write_seconds);
  figures["stages"] = stages(report);
}

}  // namespace

py::dict figures_of(const Report& report, const Run& run) {
  py::dict figures;
  add_mesh(report, figures);
  add_work(report, figures);
  figures["memory_limit"] = run.context().memory();
  figures["seconds"] = run.seconds();
  return figures;
}

py::dict figures_of(const PointCounts& counts) {
  return py::dict("read"_a = counts.read, "invalid"_a = counts.invalid,
                  "withheld"_a = counts.withheld, "lost"_a = counts.lost,
                  "every"_a = counts.skipped, "class"_a = counts.classes,
                  "returns"_a = counts.returns, "bounds"_a = counts.bounds,
                  "where"_a = counts.where, "thinned"_a = counts.thinned, "kept"_a = counts.kept());
}

py::list figures_of(const std::vector<SkippedFile>& files) {
  py::list figures;
  for (const SkippedFile& file : files) {
    figures.append(py::dict("path"_a = file.path, "message"_a = file.message));
  }
  return figures;
}

py::list figures_of(const std::vector<Attribute>& attributes) {
  py::list all;
  for (const Attribute& attribute : attributes) {
    py::dict figures;
    figures["name"] = attribute.name;
    figures["type"] = to_string(attribute.type);
    if (attribute.elements != 1) figures["elements"] = attribute.elements;
    if (attribute.scale != 1 || attribute.offset != 0) {
      figures["scale"] = attribute.scale;
      figures["offset"] = attribute.offset;
    }
    if (!attribute.unit.empty()) figures["unit"] = attribute.unit;
    if (!attribute.description.empty()) figures["description"] = attribute.description;
    all.append(figures);
  }
  return all;
}

py::object extent_of(const std::optional<Extent>& extent) {
  if (!extent) return py::none();
  return py::make_tuple(triple_of(extent->low), triple_of(extent->high));
}

py::tuple triple_of(const std::array<double, 3>& axes) {
  return py::make_tuple(axes[0], axes[1], axes[2]);
}

std::string hash_text(std::uint64_t hash) { return fmt::format("{:016x}", hash); }

}  // namespace spillway::python
