#include "formats/meshes/glb/glb_scene.h"

#include <fmt/format.h>

#include <utility>

#include "src/error.h"

namespace spillway::formats::glb {
namespace {

using Json = nlohmann::json;

constexpr Transform kIdentity = {{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}}};

/// First `inner`, then `outer`.
Transform combined(const Transform& outer, const Transform& inner) {
  Transform result{};
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 4; ++column) {
      double sum = column == 3 ? outer[row][3] : 0;
      for (int k = 0; k < 3; ++k) sum += outer[row][k] * inner[k][column];
      result[row][column] = sum;
    }
  }
  return result;
}

template <std::size_t N>
std::array<double, N> numbers(const Json& node, const char* name, std::array<double, N> absent) {
  const auto found = node.find(name);
  if (found == node.end()) return absent;
  if (found->size() != N) throw Failure(fmt::format("a node's {} needs {} numbers", name, N));
  return found->template get<std::array<double, N>>();
}

/// The matrix of a rotation given as a unit quaternion x, y, z, w.
std::array<std::array<double, 3>, 3> rotation_of(const std::array<double, 4>& q) {
  const auto [x, y, z, w] = q;
  return {{{1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)},
           {2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)},
           {2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)}}};
}

Transform transform_of(const Json& node) {
  Transform result{};
  if (node.contains("matrix")) {
    const auto columns = numbers<16>(node, "matrix", {});
    for (int row = 0; row < 3; ++row) {
      for (int column = 0; column < 4; ++column) result[row][column] = columns[column * 4 + row];
    }
    return result;
  }
  const auto translation = numbers<3>(node, "translation", {0, 0, 0});
  const auto scale = numbers<3>(node, "scale", {1, 1, 1});
  const auto rotation = rotation_of(numbers<4>(node, "rotation", {0, 0, 0, 1}));
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) {
      result[row][column] = rotation[row][column] * scale[column];
    }
    result[row][3] = translation[row];
  }
  return result;
}

}  // namespace

Point<3> apply(const Transform& transform, const Point<3>& point) {
  Point<3> result;
  for (int row = 0; row < 3; ++row) {
    const auto& r = transform[row];
    result[row] = r[0] * point[0] + r[1] * point[1] + r[2] * point[2] + r[3];
  }
  return result;
}

std::vector<NodeMesh> node_meshes(const Json& gltf) {
  const Json& scenes = gltf.at("scenes");
  const Json& scene = scenes.at(gltf.value("scene", std::size_t{0}));
  const Json nodes = gltf.value("nodes", Json::array());
  std::vector<bool> seen(nodes.size());
  std::vector<std::pair<std::size_t, Transform>> waiting;
  const auto wait_for = [&](const Json& numbers, const Transform& outer) {
    for (auto number = numbers.rbegin(); number != numbers.rend(); ++number) {
      waiting.emplace_back(number->get<std::size_t>(), outer);
    }
  };
  std::vector<NodeMesh> result;
  wait_for(scene.value("nodes", Json::array()), kIdentity);
  while (!waiting.empty()) {
    const auto [number, outer] = waiting.back();
    waiting.pop_back();
    const Json& node = nodes.at(number);
    if (seen[number]) throw Failure(fmt::format("node {} has two parents", number));
    seen[number] = true;
    const Transform transform = combined(outer, transform_of(node));
    if (node.contains("mesh")) result.push_back({node.at("mesh").get<std::size_t>(), transform});
    wait_for(node.value("children", Json::array()), transform);
  }
  return result;
}

}  // namespace spillway::formats::glb
