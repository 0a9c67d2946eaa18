#pragma once

#include <pybind11/pybind11.h>

namespace spillway::python {

/// Each adds a group to the module.
void bind_errors(pybind11::module_& module);
void bind_delaunay(pybind11::module_& module);

}  // namespace spillway::python
