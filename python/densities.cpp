// Densities of points.

#include <pybind11/stl.h>
#include <spillway/density.h>

#include <array>
#include <string>

#include "python/bindings.h"
#include "python/mesh_origin.h"
#include "python/run.h"
#include "python/statistics.h"

namespace spillway::python {
namespace {

py::dict density(Run& run, const MeshOrigin& points, const std::string& path,
                 const DensityOptions& options) {
  Report report;
  DensityTotals totals;
  run.work([&] {
    const auto sink = create_density(path, options, run.context());
    report = points.send(*sink, run);
    totals = sink->totals();
  });
  py::dict statistics = statistics_of(report, run);
  statistics["mass"] = totals.mass;
  statistics["volume"] = totals.volume;
  statistics["least"] = totals.least;
  statistics["most"] = totals.most;
  return statistics;
}

}  // namespace

void bind_densities(py::module_& module) {
  py::class_<DensityOptions>(module, "DensityOptions")
      .def(py::init())
      .def_readwrite("weight", &DensityOptions::weight)
      .def_readwrite("cells", &DensityOptions::cells)
      .def("set_grid_box", [](DensityOptions& options, const std::array<double, 3>& low,
                              const std::array<double, 3>& high) {
        options.grid_box = Extent{low, high};
      });
  module.def("density", density, py::arg("run"), py::arg("points"), py::arg("path"),
             py::arg("options"));
}

}  // namespace spillway::python
