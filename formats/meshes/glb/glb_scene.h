#pragma once
// Where the meshes of a glTF scene stand.

#include <array>
#include <cstddef>
#include <nlohmann/json.hpp>
#include <vector>

#include "src/geometry/point.h"

namespace spillway::formats::glb {

/// An affine map: three rows of four.
using Transform = std::array<std::array<double, 4>, 3>;

/// `point` under the map. Additions of zero and products with one are exact.
Point<3> apply(const Transform& transform, const Point<3>& point);

/// A mesh of the file and where it stands.
struct NodeMesh {
  std::size_t mesh = 0;
  Transform transform{};
};

/// The meshes of the default scene, in the order of its nodes. Throws Failure without the file's name
/// if the nodes make no tree, and nlohmann::json::exception for what is not as glTF has it.
std::vector<NodeMesh> node_meshes(const nlohmann::json& gltf);

}  // namespace spillway::formats::glb
