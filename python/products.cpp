// Files that are made of a mesh while it comes: the mesh itself, rasters, lines and pictures.

#include <pybind11/stl.h>
#include <spillway/contours.h>
#include <spillway/dem.h>
#include <spillway/picture.h>

#include <memory>
#include <string>
#include <utility>

#include "python/bindings.h"
#include "python/mesh_origin.h"
#include "python/statistics.h"
#include "python/text.h"

namespace spillway::python {
namespace {

/// Makes a sink, sends it the mesh, and returns it with the run's statistics.
template <typename Make>
auto send(Run& run, const MeshOrigin& origin, const Make& make) {
  decltype(make()) sink;
  Report report;
  run.work([&] {
    sink = make();
    report = origin.send(*sink, run);
  });
  return std::pair(std::move(sink), statistics_of(report, run));
}

py::dict mesh(Run& run, const MeshOrigin& origin, const std::string& output,
              const MeshFileOptions& options) {
  return send(run, origin, [&] { return create_mesh(output, options, run.context()); }).second;
}

void add_raster(const DemReport& raster, py::dict& statistics) {
  statistics["columns"] = raster.columns;
  statistics["rows"] = raster.rows;
  statistics["resolution"] = raster.resolution;
  statistics["west"] = raster.west;
  statistics["north"] = raster.north;
  statistics["bands"] = raster.bands;
  statistics["pixels_with_data"] = raster.pixels_with_data;
  statistics["files"] = raster.files;
  statistics["files_during_run"] = raster.files_during_run;
  statistics["empty_tiles"] = raster.empty_tiles;
  statistics["vrt"] = raster.vrt;
  statistics["other_files"] = raster.other_files;
  statistics["closed_tiles"] = raster.closed_tiles;
  statistics["spilled_pixel_bytes"] = raster.spilled_bytes;
  statistics["points_in_pixels"] = raster.points_in_pixels;
  statistics["pixels_with_points"] = raster.pixels_with_points;
  statistics["filled_pixels"] = raster.filled_pixels;
}

py::dict dem(Run& run, const MeshOrigin& origin, const std::string& output,
             const DemOptions& options) {
  auto [sink, statistics] =
      send(run, origin, [&] { return create_dem(output, options, run.context()); });
  add_raster(sink->report(), statistics);
  return statistics;
}

py::tuple dem_in_memory(Run& run, const MeshOrigin& origin, const DemOptions& options) {
  DemPixels pixels;
  auto [sink, statistics] =
      send(run, origin, [&] { return create_dem(pixels, options, run.context()); });
  add_raster(sink->report(), statistics);
  return py::make_tuple(statistics, array_of(std::move(pixels.values)), text_of(pixels.crs));
}

py::dict contours(Run& run, const MeshOrigin& origin, const std::string& output,
                  const ContourOptions& options) {
  auto [sink, statistics] =
      send(run, origin, [&] { return create_contours(output, options, run.context()); });
  const ContourReport& lines = sink->report();
  statistics["lines"] = lines.lines;
  statistics["short_lines"] = lines.short_lines;
  statistics["polygons"] = lines.polygons;
  statistics["line_points"] = lines.points;
  statistics["lowest"] = lines.lowest;
  statistics["highest"] = lines.highest;
  statistics["outside_tiles"] = lines.outside_tiles;
  statistics["files"] = lines.files;
  statistics["other_files"] = lines.other_files;
  statistics["spilled_line_bytes"] = lines.spilled_bytes;
  return statistics;
}

py::dict picture(Run& run, const MeshOrigin& origin, const std::string& output,
                 const PictureOptions& options) {
  auto [sink, statistics] =
      send(run, origin, [&] { return create_picture(output, options, run.context()); });
  const PictureReport& view = sink->report();
  statistics["columns"] = view.columns;
  statistics["rows"] = view.rows;
  statistics["triangles"] = view.triangles;
  statistics["description"] = view.description;
  statistics["edges_too_small"] = view.edges_too_small;
  return statistics;
}

}  // namespace

void bind_products(py::module_& module) {
  module.def("mesh", mesh, py::arg("run"), py::arg("origin"), py::arg("output"),
             py::arg("options"));
  module.def("dem", dem, py::arg("run"), py::arg("origin"), py::arg("output"), py::arg("options"));
  module.def("dem_in_memory", dem_in_memory, py::arg("run"), py::arg("origin"), py::arg("options"));
  module.def("contours", contours, py::arg("run"), py::arg("origin"), py::arg("output"),
             py::arg("options"));
  module.def("picture", picture, py::arg("run"), py::arg("origin"), py::arg("output"),
             py::arg("options"));
}

}  // namespace spillway::python
