// Files that are made of a mesh while it comes: the mesh itself, rasters, lines and pictures.

#include <pybind11/stl.h>
#include <spillway/contours.h>
#include <spillway/dem.h>
#include <spillway/picture.h>

#include <memory>
#include <string>
#include <utility>

#include "python/bindings.h"
#include "python/figures.h"
#include "python/mesh_origin.h"
#include "python/text.h"

namespace spillway::python {
namespace {

/// Makes a sink, sends it the mesh, and returns it with the run's figures.
template <typename Make>
auto send(Run& run, const MeshOrigin& origin, const Make& make) {
  decltype(make()) sink;
  Report report;
  run.work([&] {
    sink = make();
    report = origin.send(*sink, run);
  });
  return std::pair(std::move(sink), figures_of(report, run));
}

py::dict mesh(Run& run, const MeshOrigin& origin, const std::string& output,
              const MeshFileOptions& options) {
  return send(run, origin, [&] { return create_mesh(output, options, run.context()); }).second;
}

void add_raster(const DemReport& raster, py::dict& figures) {
  figures["columns"] = raster.columns;
  figures["rows"] = raster.rows;
  figures["resolution"] = raster.resolution;
  figures["west"] = raster.west;
  figures["north"] = raster.north;
  figures["bands"] = raster.bands;
  figures["pixels_with_data"] = raster.pixels_with_data;
  figures["closed_tiles"] = raster.closed_tiles;
  figures["spilled_pixel_bytes"] = raster.spilled_bytes;
}

py::dict dem(Run& run, const MeshOrigin& origin, const std::string& output,
             const DemOptions& options) {
  auto [sink, figures] =
      send(run, origin, [&] { return create_dem(output, options, run.context()); });
  add_raster(sink->report(), figures);
  return figures;
}

py::tuple dem_in_memory(Run& run, const MeshOrigin& origin, const DemOptions& options) {
  DemPixels pixels;
  auto [sink, figures] =
      send(run, origin, [&] { return create_dem(pixels, options, run.context()); });
  add_raster(sink->report(), figures);
  return py::make_tuple(figures, array_of(std::move(pixels.values)), text_of(pixels.crs));
}

py::dict contours(Run& run, const MeshOrigin& origin, const std::string& output,
                  const ContourOptions& options) {
  auto [sink, figures] =
      send(run, origin, [&] { return create_contours(output, options, run.context()); });
  const ContourReport& lines = sink->report();
  figures["lines"] = lines.lines;
  figures["line_points"] = lines.points;
  figures["lowest"] = lines.lowest;
  figures["highest"] = lines.highest;
  figures["spilled_line_bytes"] = lines.spilled_bytes;
  return figures;
}

py::dict picture(Run& run, const MeshOrigin& origin, const std::string& output,
                 const PictureOptions& options) {
  auto [sink, figures] =
      send(run, origin, [&] { return create_picture(output, options, run.context()); });
  const PictureReport& view = sink->report();
  figures["columns"] = view.columns;
  figures["rows"] = view.rows;
  figures["description"] = view.description;
  figures["edges_too_small"] = view.edges_too_small;
  return figures;
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
