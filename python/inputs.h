#pragma once

#include <pybind11/stl.h>
#include <spillway/points.h>

#include <memory>
#include <string>
#include <variant>
#include <vector>

#include "python/arrays.h"

namespace spillway::python {

/// Points as an array of rows of two or three coordinates, or the paths of files.
using Inputs = std::variant<Coordinates, std::vector<std::string>>;

/// Opens them; of the options an array has but the coordinate system. An array must stay where it
/// is while the source is read; `attributes` are what its points carry. To be called without the
/// interpreter's lock, too.
std::unique_ptr<PointSource> open_inputs(const Inputs& inputs, const PointOptions& options,
                                         const Context& context, AttributeColumns attributes = {});

/// Whether the inputs are one file of a mesh: as its first bytes and its name tell, unless
/// `mesh_format` or `point_format` does.
bool is_mesh(const Inputs& inputs, const std::string& mesh_format, const std::string& point_format,
             const Context& context);

}  // namespace spillway::python
