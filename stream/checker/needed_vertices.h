#pragma once

#include <cstdint>
#include <vector>

#include "formats/meshes/common/mesh_stream.h"
#include "formats/meshes/common/stream_vertices.h"
#include "src/geometry/point.h"

namespace spillway::checker {

/// The vertices of a mesh stream that may still be needed: those not finalized, and those that
/// somebody holds. Each has a slot, which is used again once it is free.
template <int D>
class NeededVertices {
 public:
  struct Vertex {
    Point<D> point;
    std::uint64_t number;    ///< in the stream
    std::uint32_t holders;   ///< how often held
    bool used = false;       ///< for the caller
    bool finalized = false;  ///< also in free slots
  };

  [[nodiscard]] Vertex& operator[](std::uint32_t slot) { return vertices_[slot]; }
  [[nodiscard]] const Vertex& operator[](std::uint32_t slot) const { return vertices_[slot]; }

  /// Gives the block's new vertices, whose coordinates are `points`, their numbers and slots.
  /// Appends the points of imported ones, and sets `slots`: both are then by short number.
  /// Later blocks cannot import what the block finalizes. Throws Failure for a vertex that cannot be
  /// imported.
  void enter(const MeshStreamBlock& block, std::vector<Point<D>>& points,
             std::vector<std::uint32_t>& slots);

  /// The vertex is needed no more, unless it is held. Throws Failure if it has been finalized before.
  void finalize(std::uint32_t slot);

  /// Keeps a vertex, finalized or not, until as many calls of release().
  void hold(std::uint32_t slot) { ++vertices_[slot].holders; }
  void release(std::uint32_t slot) {
    Vertex& vertex = vertices_[slot];
    if (--vertex.holders == 0 && vertex.finalized) free_.push_back(slot);
  }

  /// Number of vertices that have come so far.
  [[nodiscard]] std::uint64_t announced() const { return importable_.announced(); }

  /// The most slots that were in use at a time.
  [[nodiscard]] std::uint64_t peak() const { return vertices_.size(); }

  /// Calls f(vertex) for every vertex that is not finalized.
  template <typename F>
  void for_each_not_finalized(F&& f) const {
    for (const Vertex& vertex : vertices_) {
      if (!vertex.finalized) f(vertex);
    }
  }

 private:
  std::uint32_t add(const Point<D>& point, std::uint64_t number);

  std::vector<Vertex> vertices_;  // by slot
  std::vector<std::uint32_t> free_;
  StreamVertices<std::uint32_t> importable_;  // slots
};

}  // namespace spillway::checker
