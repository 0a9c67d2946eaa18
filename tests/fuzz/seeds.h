#pragma once
// Small files that are right, made by our own writers and by what tests make files with.

#include <string>
#include <string_view>
#include <vector>

#include "formats/meshes/common/mesh_format.h"
#include "formats/points/common/point_format.h"

namespace spillway::test {

/// Files of the format, written in all its versions and with attributes; none if it is not written
/// and nobody has made one here.
std::vector<std::string> point_seeds(const PointFormat& format);
std::vector<std::string> mesh_seeds(const MeshFormat& format);

/// Files of a format that others write in ways that we do not, by its name.
std::vector<std::string> foreign_points(std::string_view format);
std::vector<std::string> foreign_meshes(std::string_view format);

}  // namespace spillway::test
