// Meshes block by block, as arrays.

#include <pybind11/stl.h>

#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

#include "python/attributes.h"
#include "python/bindings.h"
#include "python/block_stream.h"
#include "python/periodic.h"
#include "python/statistics.h"

namespace spillway::python {
namespace {

/// Numbers of vertices as rows: signed, since NumPy makes floating-point numbers of sums of
/// unsigned and signed ones.
py::array rows_of_numbers(std::vector<std::uint64_t> numbers, int columns) {
  auto kept = std::make_unique<std::vector<std::uint64_t>>(std::move(numbers));
  const auto* const first = reinterpret_cast<const std::int64_t*>(kept->data());
  const auto rows = static_cast<py::ssize_t>(kept->size()) / columns;
  return py::array_t<std::int64_t>({rows, static_cast<py::ssize_t>(columns)}, first,
                                   keep(std::move(kept)));
}

py::array row_of_numbers(std::vector<std::uint64_t> numbers) {
  return rows_of_numbers(std::move(numbers), 1).reshape({-1});
}

/// The vertices as rows of all their coordinates: those beyond z are taken out of the attributes.
py::array rows_of_vertices(MeshBlock& block, const MeshHeader& header, py::dict& attributes) {
  py::array rows = array_of(std::move(block.vertices));
  if (header.dimension <= 3) return rows;
  py::list columns;
  columns.append(rows);
  for (int axis = 3; axis < header.dimension; ++axis) {
    const py::str name(header.attributes[static_cast<std::size_t>(axis) - 3].name);
    columns.append(attributes.attr("pop")(name));
  }
  return py::module_::import("numpy").attr("column_stack")(columns);
}

/// Of a periodic mesh, for each corner which copy of the vertex it is.
py::object offsets_of(std::vector<std::int8_t> offsets, const MeshHeader& header) {
  if (!header.periodic) return py::none();
  auto kept = std::make_unique<std::vector<std::int8_t>>(std::move(offsets));
  const auto dimension = static_cast<py::ssize_t>(header.dimension);
  const auto simplices = static_cast<py::ssize_t>(kept->size()) / (dimension * (dimension + 1));
  const std::int8_t* const first = kept->data();
  return py::array_t<std::int8_t>({simplices, dimension + 1, dimension}, first,
                                  keep(std::move(kept)));
}

/// A block as (first_vertex, vertices, simplices, finalized, input_index, attributes, offsets), or
/// None at the end.
py::object next_block(BlockStream& stream) {
  std::optional<MeshBlock> block = stream.next();
  if (!block) return py::none();
  const MeshHeader& header = stream.header();
  py::object index = py::none();
  if (header.has_input_index) index = row_of_numbers(std::move(block->input_index));
  py::dict attributes = arrays_of(std::move(block->attributes));
  const py::array vertices = rows_of_vertices(*block, header, attributes);
  const py::object offsets = offsets_of(std::move(block->offsets), header);
  return py::make_tuple(block->first_vertex, vertices,
                        rows_of_numbers(std::move(block->corners), header.dimension + 1),
                        row_of_numbers(std::move(block->finalized)), index, attributes, offsets);
}

}  // namespace

void bind_blocks(py::module_& module) {
  py::class_<BlockStream, std::unique_ptr<BlockStream, StreamEnd>>(module, "BlockStream")
      .def(py::init<std::shared_ptr<Run>, std::shared_ptr<MeshOrigin>, std::vector<std::string>>(),
           py::arg("run"), py::arg("origin"), py::arg("attributes"))
      .def("next", next_block)
      .def("close", &BlockStream::close)
      .def_property_readonly(
          "periodic", [](const BlockStream& stream) { return box_tuple(stream.header().periodic); })
      .def_property_readonly("report", [](const BlockStream& stream) -> py::object {
        if (!stream.report()) return py::none();
        return statistics_of(*stream.report(), stream.run());
      });
}

}  // namespace spillway::python
