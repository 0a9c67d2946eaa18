#include "python/mesh_origin.h"

#include <pybind11/stl.h>
#include <spillway/convert.h>
#include <spillway/error.h>

#include <memory>
#include <utility>

#include "python/attributes.h"
#include "python/bindings.h"

namespace spillway::python {
namespace {

void refuse_choice_of_heights(const TriangulateOptions& how, const PointsHeader& points) {
  if (how.heights == Heights::kFirst || points.coordinates == 3) return;
  throw Error(ErrorCode::kInvalidArgument,
              "heights has no effect on points without z: leave it out");
}

}  // namespace

MeshOrigin::MeshOrigin(Inputs inputs, PointOptions options, TriangulateOptions how,
                       AttributeColumns attributes, std::vector<int> ground_classes)
    : from_(Points{std::move(inputs), std::move(options), std::move(how), std::move(attributes),
                   std::move(ground_classes)}) {}

MeshOrigin::MeshOrigin(std::string path, MeshOptions options)
    : from_(File{std::move(path), std::move(options)}) {}

Report MeshOrigin::send(MeshSink& sink, Run& run) const {
  const Context& context = run.context();
  if (const auto* const file = std::get_if<File>(&from_)) {
    run.expect(kPhasesOfMesh);
    const auto mesh = open_mesh(file->path, file->options, context);
    return convert(*mesh, sink, context);
  }
  const auto& [inputs, options, how, attributes, ground_classes] = std::get<Points>(from_);
  run.expect(kPhasesOfPoints);
  if (!ground_classes.empty()) {
    TriangulateOptions of_ground = how;
    of_ground.heights = Heights::kFirst;
    of_ground.max_edge.reset();
    const PointsAboveGround above = open_above_ground(
        std::get<std::vector<std::string>>(inputs), options, ground_classes,
        {.min_height = 0, .foreign_crs = options.foreign_crs}, of_ground, context);
    return triangulate(*above.points, sink, how, context);
  }
  const auto points = open_inputs(inputs, options, context, attributes);
  refuse_choice_of_heights(how, points->header());
  return triangulate(*points, sink, how, context);
}

HeightReport MeshOrigin::measure_heights(PointSource& points, PointSink& sink,
                                         const HeightOptions& options, Run& run) const {
  const Context& context = run.context();
  if (const auto* const file = std::get_if<File>(&from_)) {
    const auto mesh = open_mesh(file->path, file->options, context);
    return spillway::measure_heights(points, *mesh, sink, options, context);
  }
  const auto& [inputs, of_ground, how, attributes, classes] = std::get<Points>(from_);
  const auto ground = open_inputs(inputs, of_ground, context, attributes);
  return spillway::measure_heights(points, *ground, sink, options, how, context);
}

void bind_mesh_origin(py::module_& module) {
  py::class_<MeshOrigin, std::shared_ptr<MeshOrigin>>(module, "MeshOrigin")
      .def(py::init([](Inputs inputs, PointOptions options, TriangulateOptions how,
                       const py::dict& attributes, std::vector<int> ground_classes) {
             return std::make_shared<MeshOrigin>(std::move(inputs), std::move(options),
                                                 std::move(how), columns_of(attributes),
                                                 std::move(ground_classes));
           }),
           py::arg("inputs"), py::arg("options"), py::arg("how"), py::arg("attributes"),
           py::arg("ground_classes") = std::vector<int>{})
      .def(py::init<std::string, MeshOptions>(), py::arg("path"), py::arg("options"));
  module.def(
      "is_mesh",
      [](Run& run, const Inputs& inputs, const std::string& mesh_format,
         const std::string& point_format) {
        bool found = false;
        run.look([&] { found = is_mesh(inputs, mesh_format, point_format, run.context()); });
        return found;
      },
      py::arg("run"), py::arg("inputs"), py::arg("mesh_format"), py::arg("point_format"));
}

}  // namespace spillway::python
