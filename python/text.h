#pragma once

#include <pybind11/pybind11.h>

#include <string_view>

namespace spillway::python {

/// A text of the library, which may have names of files in it, and what files say. Bytes that are
/// not UTF-8 become what os.fsdecode() makes of them.
inline pybind11::str text_of(std::string_view text) {
  PyObject* const made =
      PyUnicode_DecodeUTF8(text.data(), static_cast<Py_ssize_t>(text.size()), "surrogateescape");
  if (made == nullptr) throw pybind11::error_already_set();
  return pybind11::reinterpret_steal<pybind11::str>(made);
}

}  // namespace spillway::python
