#pragma once

#include <pybind11/pybind11.h>

namespace spillway::python {

namespace py = pybind11;

/// Each adds a group to the module.
void bind_errors(py::module_& module);
void bind_delaunay(py::module_& module);
void bind_run(py::module_& module);
void bind_options(py::module_& module);
void bind_mesh_origin(py::module_& module);
void bind_products(py::module_& module);
void bind_heights(py::module_& module);
void bind_volumes(py::module_& module);
void bind_densities(py::module_& module);
void bind_points(py::module_& module);
void bind_questions(py::module_& module);
void bind_blocks(py::module_& module);

}  // namespace spillway::python
