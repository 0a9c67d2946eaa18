// What files hold, and whether a mesh is a Delaunay triangulation.

#include <fmt/format.h>
#include <pybind11/stl.h>
#include <spillway/check.h>
#include <spillway/info.h>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "python/bindings.h"
#include "python/inputs.h"
#include "python/run.h"
#include "python/statistics.h"
#include "python/text.h"

namespace spillway::python {
namespace {

constexpr PhaseShare kPhasesOfInfo[] = {{"read", 0, 1}};
constexpr PhaseShare kPhasesOfCheck[] = {{"read mesh", 0, 0.3},
                                         {"check", 0.3, 0.7},
                                         {"read points", 0.7, 0.85},
                                         {"divide", 0.85, 0.9},
                                         {"compare", 0.9, 1}};

py::object text_or_none(const std::string& text) {
  return text.empty() ? py::object(py::none()) : py::object(text_of(text));
}

py::list texts_of(const std::vector<std::string>& lines) {
  py::list texts;
  for (const std::string& line : lines) texts.append(text_of(line));
  return texts;
}

void add_lattice(const std::optional<LatticeInfo>& lattice, py::dict& statistics) {
  statistics["scale"] = lattice ? py::object(triple_of(lattice->scale)) : py::none();
  statistics["offset"] = lattice ? py::object(triple_of(lattice->offset)) : py::none();
}

/// Of each number that there is, how many points are of it.
py::dict counts_of(const std::vector<std::uint64_t>& counts) {
  py::dict all;
  for (std::size_t number = 0; number < counts.size(); ++number) {
    if (counts[number] > 0) all[py::int_(number)] = counts[number];
  }
  return all;
}

py::dict flags_of(const PointsInfo& info) {
  py::dict all;
  for (const auto& [name, count] : info.flags) all[py::str(name)] = count;
  return all;
}

/// As in the JSON of the command; None where the file is no text.
py::object table_of(const PointsInfo& info) {
  if (!info.table) return py::none();
  const TableInfo& table = *info.table;
  py::object columns = py::cast(table.columns);
  if (!table.characters.empty()) {
    py::list ranges;
    for (const auto& [first, last] : table.characters) {
      ranges.append(fmt::format("{}-{}", first, last));
    }
    columns = ranges;
  }
  py::dict told;
  told["separator"] = table.separator;
  told["decimal"] = table.decimal == ',' ? "comma" : "point";
  told["names"] = table.names.empty() ? py::object(py::none()) : texts_of(table.names);
  told["columns"] = columns;
  told["counts_downwards"] = table.counts_downwards;
  told["first_line"] = table.first_line == 0 ? py::object(py::none()) : py::cast(table.first_line);
  told["first_rows"] = texts_of(table.first_rows);
  return told;
}

py::dict points_info(Run& run, const std::string& path, const PointOptions& options, bool fast) {
  PointsInfo info;
  run.expect(kPhasesOfInfo);
  run.work([&] {
    info = fast ? describe_header(path, options, run.context())
                : describe_points(path, options, run.context());
  });
  py::dict statistics;
  statistics["format"] = info.format;
  statistics["version"] = text_or_none(info.version);
  statistics["point_format"] =
      info.point_format < 0 ? py::object(py::none()) : py::object(py::int_(info.point_format));
  statistics["coordinates"] = info.coordinates;
  if (fast) {
    statistics["points"] = info.header_points;
  } else {
    statistics["points"] = info.counts.kept();
  }
  statistics["filters"] = statistics_of(info.counts);
  statistics["extent"] = extent_of(info.extent);
  statistics["header_box"] = extent_of(info.header_box);
  statistics["points_outside"] =
      info.header_box && !fast ? py::object(py::int_(info.points_outside)) : py::object(py::none());
  add_lattice(info.lattice, statistics);
  statistics["crs"] = text_or_none(info.crs);
  statistics["crs_note"] = text_or_none(info.crs_note);
  statistics["software"] = text_or_none(info.software);
  statistics["cells"] = info.cells;
  statistics["classes"] = counts_of(info.classes);
  statistics["returns"] = counts_of(info.returns);
  statistics["flags"] = flags_of(info);
  statistics["table"] = table_of(info);
  py::list attributes = statistics_of(info.attributes);
  for (std::size_t a = 0; a < info.ranges.size(); ++a) {
    if (std::isnan(info.ranges[a][0])) continue;
    attributes[a]["min"] = info.ranges[a][0];
    attributes[a]["max"] = info.ranges[a][1];
  }
  statistics["attributes"] = attributes;
  return statistics;
}

/// Lowest and highest sides, None along open axes.
py::object periodic_of(const std::optional<PeriodicBox>& periodic, int dimension) {
  if (!periodic) return py::none();
  py::tuple low(dimension);
  py::tuple high(dimension);
  for (int k = 0; k < dimension; ++k) {
    const auto side = [&](double place) {
      return periodic->periodic[k] ? py::object(py::float_(place)) : py::object(py::none());
    };
    low[k] = side(periodic->box.low[k]);
    high[k] = side(periodic->box.high[k]);
  }
  return py::make_tuple(low, high);
}

py::dict mesh_info(Run& run, const std::string& path, const MeshOptions& options) {
  MeshInfo info;
  run.expect(kPhasesOfInfo);
  run.work([&] { info = describe_mesh(path, options, run.context()); });
  const MeshTotals& totals = info.totals;
  py::dict statistics;
  statistics["format"] = info.format;
  statistics["dimension"] = info.dimension;
  statistics["vertices"] = totals.vertices;
  statistics["simplices"] = totals.simplices;
  statistics["hull_facets"] = totals.hull_facets;
  statistics["canonical_hash"] = hash_text(totals.canonical_hash);
  statistics["points"] = info.tells_totals ? py::object(py::int_(totals.points)) : py::none();
  statistics["duplicates"] =
      info.tells_totals ? py::object(py::int_(totals.duplicates)) : py::none();
  statistics["extent"] = extent_of(info.extent, info.further_extent);
  add_lattice(info.lattice, statistics);
  statistics["input_index"] = info.has_input_index;
  statistics["crs"] = text_or_none(info.crs);
  statistics["peak_live_vertices"] = info.peak_live_vertices;
  statistics["attributes"] = statistics_of(info.attributes);
  statistics["periodic"] = periodic_of(info.periodic, info.dimension);
  return statistics;
}

py::dict statistics_of(const CheckReport& report, int dimension) {
  py::dict statistics;
  statistics["dimension"] = dimension;
  statistics["vertices"] = report.vertices;
  statistics["simplices"] = report.simplices;
  statistics["hull_facets"] = report.hull_facets;
  statistics["canonical_hash"] = hash_text(report.canonical_hash);
  statistics["on_lattice"] = report.on_lattice;
  statistics["properties"] = texts_of(report.proved);
  statistics["faults"] = texts_of(report.faults);
  statistics["fault_count"] = report.fault_count;
  statistics["off_lattice"] = report.off_lattice;
  statistics["other_ties"] = report.other_ties;
  statistics["peak_live_vertices"] = report.peak_live_vertices;
  statistics["peak_open_facets"] = report.peak_open_facets;
  statistics["filters"] = python::statistics_of(report.points);
  return statistics;
}

py::dict check_mesh(Run& run, const std::string& path, const MeshOptions& options,
                    bool any_delaunay, const std::optional<Inputs>& inputs,
                    const PointOptions& point_options) {
  CheckReport report;
  int dimension = 2;
  run.expect(kPhasesOfCheck);
  run.work([&] {
    const auto mesh = open_mesh(path, options, run.context());
    dimension = mesh->header().dimension;
    std::unique_ptr<PointSource> points;
    if (inputs) {
      PointOptions how = point_options;
      how.dimension = dimension;
      points = open_inputs(*inputs, how, run.context());
    }
    report = check(*mesh, {.any_delaunay = any_delaunay}, run.context(), points.get());
  });
  return statistics_of(report, dimension);
}

}  // namespace

void bind_questions(py::module_& module) {
  module.def("points_info", points_info, py::arg("run"), py::arg("path"), py::arg("options"),
             py::arg("fast"));
  module.def("mesh_info", mesh_info, py::arg("run"), py::arg("path"), py::arg("options"));
  module.def("check", check_mesh, py::arg("run"), py::arg("path"), py::arg("options"),
             py::arg("any_delaunay"), py::arg("points"), py::arg("point_options"));
}

}  // namespace spillway::python
