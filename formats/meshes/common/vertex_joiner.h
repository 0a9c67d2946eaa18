#pragma once

#include <cstdint>
#include <functional>
#include <unordered_map>

#include "formats/meshes/common/mesh.h"

namespace spillway::formats {

/// Makes a mesh of triangles whose corners are given by their coordinates: equal corners become one
/// vertex.
class VertexJoiner {
 public:
  /// `mesh` must outlive the joiner.
  explicit VertexJoiner(Mesh& mesh) : mesh_(mesh) {}

  /// Appends the corner of a simplex.
  void add(const WorldPoint& corner) {
    const auto [found, is_new] = numbers_.try_emplace(corner, mesh_.vertices.size());
    if (is_new) mesh_.vertices.push_back(corner);
    mesh_.corners.push_back(found->second);
  }

  /// Sets the header's counts.
  void finish() {
    mesh_.header.vertices = mesh_.vertices.size();
    mesh_.header.simplices = mesh_.corners.size() / mesh_.corners_per_simplex();
  }

 private:
  struct Hash {
    std::size_t operator()(const WorldPoint& point) const {
      std::size_t hash = 0;
      for (const double coordinate : point) {
        hash = (hash ^ std::hash<double>()(coordinate)) * 0x9E3779B97F4A7C15U;
        hash ^= hash >> 32U;
      }
      return hash;
    }
  };

  Mesh& mesh_;
  std::unordered_map<WorldPoint, std::uint64_t, Hash> numbers_;
};

}  // namespace spillway::formats
