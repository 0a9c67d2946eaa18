#pragma once

#include <pybind11/pybind11.h>
#include <spillway/delaunay.h>

#include <functional>

namespace spillway::python {

/// Runs `work` without the interpreter's lock, in a thread of its own, while the caller's thread
/// looks for signals and tells `progress`, a callable or None, the fraction that is done:
/// everything of Python happens in the thread that called. `work` gets options with a stop token
/// and a progress function, and returns when it is done.
///
/// Throws what `work` throws. After an exception of a signal's handler (KeyboardInterrupt) or of
/// `progress` the work is told to stop; when it has, that exception is thrown.
void run_watched(const pybind11::object& progress,
                 const std::function<void(const DelaunayOptions&)>& work);

}  // namespace spillway::python
