#pragma once
// Attributes of points, between NumPy and the library.

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <spillway/attribute_columns.h>

namespace spillway::python {

/// The columns of a dict from names to arrays: a row for each point, of one number or several, in
/// native byte order. Throws py::value_error for other arrays.
AttributeColumns columns_of(const pybind11::dict& arrays);

/// A dict from names to arrays of what is stored, which share the columns' memory. Shape: (n,), or
/// (n, elements) of arrays.
pybind11::dict arrays_of(AttributeColumns columns);

}  // namespace spillway::python
