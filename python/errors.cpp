#include <pybind11/pybind11.h>
#include <spillway/error.h>

#include <exception>
#include <new>
#include <stdexcept>
#include <utility>

#include "python/advice.h"
#include "python/bindings.h"
#include "python/text.h"

namespace spillway::python {
namespace {

namespace py = pybind11;

void translate(std::exception_ptr fault) {
  try {
    std::rethrow_exception(std::move(fault));
  } catch (const Error& error) {
    const py::object make = py::module_::import("spillway.errors").attr("make_error");
    const ErrorFacts& facts = error.facts();
    const py::object made =
        make(to_string(error.code()), text_of(advised_message(error)), text_of(facts.file),
             to_string(facts.place.unit), facts.place.number, facts.system_error);
    PyErr_SetObject(py::type::handle_of(made).ptr(), made.ptr());
  } catch (const std::bad_alloc&) {
    PyErr_SetString(PyExc_MemoryError, "memory ran out");
  } catch (const std::length_error&) {
    PyErr_SetString(PyExc_MemoryError, "memory ran out: no array can be so long");
  }
}

}  // namespace

void bind_errors(py::module_& /*module*/) { py::register_local_exception_translator(translate); }

}  // namespace spillway::python
