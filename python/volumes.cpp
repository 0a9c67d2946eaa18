// Volumes between surfaces, and above a level.

#include <pybind11/stl.h>
#include <spillway/volume.h>

#include <memory>
#include <utility>

#include "python/bindings.h"
#include "python/mesh_origin.h"
#include "python/run.h"
#include "python/statistics.h"

namespace spillway::python {
namespace {

py::dict statistics_of(const Report& first, const Volume& volume, const Run& run) {
  py::dict statistics = statistics_of(first, run);
  statistics["cut"] = volume.cut;
  statistics["fill"] = volume.fill;
  statistics["cut_area"] = volume.cut_area;
  statistics["fill_area"] = volume.fill_area;
  statistics["area"] = volume.area;
  statistics["first_area"] = volume.first_area;
  statistics["second_area"] = volume.second_area;
  statistics["spilled_triangle_bytes"] = volume.spilled_bytes;
  return statistics;
}

py::dict volume_between(Run& run, const MeshOrigin& first, const MeshOrigin& second,
                        const VolumeOptions& options) {
  Report report;
  Volume volume;
  run.work([&] {
    const auto between = measure_between(options, run.context());
    report = first.send(between->first(), run);
    (void)second.send(between->second(), run);
    volume = between->measure();
  });
  return statistics_of(report, volume, run);
}

py::dict volume_above(Run& run, const MeshOrigin& surface, double level,
                      const VolumeOptions& options) {
  Report report;
  Volume volume;
  run.work([&] {
    const auto above = measure_above(level, options, run.context());
    report = surface.send(*above, run);
    volume = above->volume();
  });
  return statistics_of(report, volume, run);
}

}  // namespace

void bind_volumes(py::module_& module) {
  py::class_<VolumeOptions>(module, "VolumeOptions")
      .def(py::init())
      .def_readwrite("max_edge", &VolumeOptions::max_edge)
      .def_readwrite("z_factor", &VolumeOptions::z_factor)
      .def_readwrite("foreign_crs", &VolumeOptions::foreign_crs);
  module.def("volume_between", volume_between, py::arg("run"), py::arg("first"), py::arg("second"),
             py::arg("how"));
  module.def("volume_above", volume_above, py::arg("run"), py::arg("surface"), py::arg("level"),
             py::arg("how"));
}

}  // namespace spillway::python
