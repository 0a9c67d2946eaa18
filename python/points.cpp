// Points in and out: other formats, and points to try things with.

#include <pybind11/stl.h>
#include <spillway/convert.h>
#include <spillway/generate.h>

#include <array>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "python/attributes.h"
#include "python/bindings.h"
#include "python/inputs.h"
#include "python/run.h"
#include "python/statistics.h"

namespace spillway::python {
namespace {

constexpr PhaseShare kPhasesOfConversion[] = {{"convert", 0, 1}};
constexpr PhaseShare kPhasesOfSorting[] = {
    {"read", 0, 0.5}, {"divide", 0.5, 0.55}, {"write", 0.55, 1}};
constexpr PhaseShare kPhasesOfGrid[] = {{"measure", 0, 0.4}, {"generate", 0.4, 1}};
constexpr PhaseShare kPhasesOfGeneration[] = {{"generate", 0, 1}};

py::dict statistics_of(const PointConversion& done, const Run& run) {
  py::dict statistics;
  statistics["written"] = done.written;
  statistics["filters"] = python::statistics_of(done.points);
  statistics["skipped_files"] = python::statistics_of(done.skipped_files);
  statistics["rounded"] = done.rounded;
  statistics["scale"] = done.rounded ? py::object(triple_of(done.scale)) : py::none();
  statistics["offset"] = done.rounded ? py::object(triple_of(done.offset)) : py::none();
  statistics["farthest"] = done.farthest;
  statistics["adds_heights"] = done.adds_heights;
  statistics["lost"] = done.lost;
  statistics["cells"] = done.cells;
  statistics["spilled_points"] = done.spilled_points;
  statistics["spilled_bytes"] = done.spilled_bytes;
  statistics["seconds"] = run.seconds();
  return statistics;
}

py::dict convert_points(Run& run, const Inputs& inputs, const PointOptions& options,
                        const std::string& output, const PointFileOptions& how,
                        const py::dict& attributes) {
  PointConversion done;
  AttributeColumns columns = columns_of(attributes);
  run.expect(how.sorted ? Phases(kPhasesOfSorting) : Phases(kPhasesOfConversion));
  run.work([&] {
    const auto file = create_points(output, how, run.context());
    const auto points = open_inputs(inputs, options, run.context(), std::move(columns));
    done = convert(*points, *file, run.context());
  });
  return statistics_of(done, run);
}

py::dict generate(Run& run, const GenerateOptions& options, const std::string& output,
                  const PointFileOptions& how) {
  PointConversion done;
  run.expect(kPhasesOfGeneration);
  run.work([&] {
    const auto points = generate_points(options);
    const auto file = create_points(output, how, run.context());
    done = convert(*points, *file, run.context());
  });
  return py::dict(py::arg("points") = done.written, py::arg("files") = 1,
                  py::arg("seconds") = run.seconds());
}

py::dict generate_survey(Run& run, const GenerateOptions& options, const std::string& output,
                         const GridOptions& grid) {
  GridReport done;
  run.expect(kPhasesOfGrid);
  run.work([&] { done = generate_grid(options, output, grid, run.context()); });
  return py::dict(py::arg("points") = done.points, py::arg("files") = done.files,
                  py::arg("seconds") = run.seconds());
}

/// Keeps points as rows of `columns` coordinates, and of what they carry what is wanted.
class Rows final : public PointSink {
 public:
  explicit Rows(std::vector<std::string> wanted = {}) : wanted_(std::move(wanted)) {}

  [[nodiscard]] std::vector<std::string> attributes_wanted() const override { return wanted_; }

  /// Memory that is too little is told before the work.
  void begin(const PointsHeader& header) override {
    columns_ = header.coordinates;
    numbers_.reserve(header.count.value_or(0) * columns_);
    attributes_ = AttributeColumns(header.attributes);
  }

  void write(std::span<const Point<3>> points) override { write(points, {}); }
  void write(std::span<const Point<3>> points, const AttributeColumns& attributes) override {
    attributes_.append(attributes);
    for (const Point<3>& point : points) {
      numbers_.insert(numbers_.end(), point.begin(), point.begin() + columns_);
    }
  }

  /// With the interpreter's lock; what is kept is given away.
  py::array_t<double> take() {
    const auto rows = static_cast<py::ssize_t>(numbers_.size() / columns_);
    return array_of(std::move(numbers_)).reshape({rows, static_cast<py::ssize_t>(columns_)});
  }

  /// Likewise; by name what the numbers mean, as they are stored unless they are scaled.
  py::dict take_attributes() {
    py::dict scaled;
    for (const Attribute& attribute : attributes_.attributes()) {
      if (attribute.scale == 1 && attribute.offset == 0) continue;
      std::vector<py::ssize_t> shape = {static_cast<py::ssize_t>(attributes_.size())};
      if (attribute.elements != 1) shape.push_back(static_cast<py::ssize_t>(attribute.elements));
      scaled[py::str(attribute.name)] = array_of(attributes_.meant(attribute.name)).reshape(shape);
    }
    py::dict all = arrays_of(std::move(attributes_));
    for (const auto& [name, numbers] : scaled) all[name] = numbers;
    return all;
  }

 private:
  std::vector<std::string> wanted_;
  int columns_ = 3;
  std::vector<double> numbers_;
  AttributeColumns attributes_;
};

/// Coordinates as rows, and by name what points carry.
py::tuple read_points(Run& run, const Inputs& inputs, const PointOptions& options) {
  Rows rows(options.attributes);
  run.expect(kPhasesOfConversion);
  run.work([&] {
    const auto points = open_inputs(inputs, options, run.context());
    convert(*points, rows, run.context());
  });
  return py::make_tuple(rows.take(), rows.take_attributes());
}

py::array_t<double> generate_in_memory(Run& run, const GenerateOptions& options) {
  Rows rows;
  run.expect(kPhasesOfGeneration);
  run.work([&] {
    const auto points = generate_points(options);
    convert(*points, rows, run.context());
  });
  if (options.dimension <= 3) return rows.take();
  py::list columns;
  columns.append(rows.take());
  for (const auto& [name, numbers] : rows.take_attributes()) columns.append(numbers);
  return py::module_::import("numpy").attr("column_stack")(columns);
}

}  // namespace

void bind_points(py::module_& module) {
  module.def("convert_points", convert_points, py::arg("run"), py::arg("inputs"),
             py::arg("options"), py::arg("output"), py::arg("how"), py::arg("attributes"));
  module.def("read_points", read_points, py::arg("run"), py::arg("inputs"), py::arg("options"));
  module.def("generate", generate, py::arg("run"), py::arg("options"), py::arg("output"),
             py::arg("how"));
  module.def("generate_survey", generate_survey, py::arg("run"), py::arg("options"),
             py::arg("output"), py::arg("grid"));
  module.def("generate_in_memory", generate_in_memory, py::arg("run"), py::arg("options"));
}

}  // namespace spillway::python
