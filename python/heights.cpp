// Heights of points above a ground, to a file or as an array.

#include <pybind11/stl.h>
#include <spillway/height.h>

#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "python/attributes.h"
#include "python/bindings.h"
#include "python/inputs.h"
#include "python/mesh_origin.h"
#include "python/run.h"
#include "python/statistics.h"

namespace spillway::python {
namespace {

constexpr PhaseShare kPhasesOfHeights[] = {{"deal", 0, 0.2},        {"read", 0.2, 0.4},
                                           {"divide", 0.4, 0.45},   {"triangulate", 0.45, 0.8},
                                           {"triangles", 0.2, 0.8}, {"locate", 0.8, 0.85},
                                           {"write", 0.85, 1}};

/// Keeps the heights alone.
class HeightColumn final : public PointSink {
 public:
  [[nodiscard]] std::vector<std::string> attributes_wanted() const override { return {}; }
  void write(std::span<const Point<3>> /*points*/) override {}
  void write(std::span<const Point<3>> /*points*/, const AttributeColumns& attributes) override {
    const std::span<const double> some = attributes.values<double>(kHeightAttribute);
    heights.insert(heights.end(), some.begin(), some.end());
  }

  std::vector<double> heights;
};

py::dict statistics_of(const HeightReport& report, const Run& run) {
  py::dict statistics = statistics_of(report.ground, run);
  statistics["written"] = report.points.written;
  statistics["without_ground"] = report.without_ground;
  statistics["below_ground"] = report.below_ground;
  statistics["other_heights"] = report.other_heights;
  statistics["lowest"] = report.lowest;
  statistics["highest"] = report.highest;
  statistics["spilled_height_bytes"] = report.spilled_bytes;
  return statistics;
}

/// `ground` is told the sink that heights go to.
HeightReport measure(Run& run, const Inputs& inputs, const PointOptions& options,
                     AttributeColumns&& columns, const MeshOrigin& ground, PointSink& sink,
                     const HeightOptions& how) {
  run.expect(kPhasesOfHeights);
  const auto points = open_inputs(inputs, options, run.context(), std::move(columns));
  return ground.measure_heights(*points, sink, how, run);
}

py::dict heights(Run& run, const Inputs& inputs, const PointOptions& options,
                 const py::dict& attributes, const MeshOrigin& ground, const HeightOptions& how,
                 const std::string& output, const PointFileOptions& written) {
  AttributeColumns columns = columns_of(attributes);
  HeightReport report;
  run.work([&] {
    const auto file = create_points(output, written, run.context());
    report = measure(run, inputs, options, std::move(columns), ground, *file, how);
  });
  return statistics_of(report, run);
}

py::tuple heights_in_memory(Run& run, const Inputs& inputs, const PointOptions& options,
                            const MeshOrigin& ground, const HeightOptions& how) {
  HeightColumn column;
  HeightReport report;
  run.work([&] { report = measure(run, inputs, options, {}, ground, column, how); });
  return py::make_tuple(statistics_of(report, run), array_of(std::move(column.heights)));
}

}  // namespace

void bind_heights(py::module_& module) {
  py::class_<HeightOptions>(module, "HeightOptions")
      .def(py::init())
      .def_readwrite("replace_z", &HeightOptions::replace_z)
      .def_readwrite("min_height", &HeightOptions::min_height)
      .def_readwrite("max_height", &HeightOptions::max_height)
      .def_readwrite("nodata", &HeightOptions::nodata)
      .def_readwrite("foreign_crs", &HeightOptions::foreign_crs);
  module.def("heights", heights, py::arg("run"), py::arg("inputs"), py::arg("options"),
             py::arg("attributes"), py::arg("ground"), py::arg("how"), py::arg("output"),
             py::arg("written"));
  module.def("heights_in_memory", heights_in_memory, py::arg("run"), py::arg("inputs"),
             py::arg("options"), py::arg("ground"), py::arg("how"));
}

}  // namespace spillway::python
