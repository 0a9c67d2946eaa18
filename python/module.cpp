// The extension `spillway._spillway`. What users see of it stands in the Python files beside it.

#include <pybind11/pybind11.h>
#include <spillway/context.h>
#include <spillway/version.h>

#include <string>

#include "python/bindings.h"

PYBIND11_MODULE(_spillway, module) {
  namespace python = spillway::python;
  module.attr("version") = std::string(spillway::version());
  // A child of fork() has none of its parent's threads. If the library still counted on them, it
  // would wait for them.
  module.def(
      "end_threads", [] { const spillway::Context last; },
      "End the threads that the library keeps for later calls, unless some are at work.");
  python::bind_errors(module);
  python::bind_delaunay(module);
  python::bind_run(module);
  python::bind_options(module);
  python::bind_mesh_origin(module);
  python::bind_products(module);
  python::bind_heights(module);
  python::bind_volumes(module);
  python::bind_densities(module);
  python::bind_points(module);
  python::bind_questions(module);
  python::bind_blocks(module);
}
