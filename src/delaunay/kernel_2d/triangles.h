#pragma once
// The triangles of a triangulation in the plane, each in a cache line of its own.

#include <cstddef>
#include <cstdint>

#include "src/geometry/point.h"

namespace spillway::delaunay::kernel_2d {

/// A vertex's place in a triangle, and the edge opposite to it: 16 * triangle + slot (0, 1 or 2).
using Handle = std::uint32_t;

/// Three vertices, counter-clockwise, with the circumcircle: for a query q and s = |q - centre|^2,
/// the triangle is in conflict if s < inner, and not in conflict if s > outer; else the upper
/// stages decide. NaN where s proves nothing, as in infinite triangles.
struct alignas(64) Triangle {
  VertexId vertices[4];  ///< the last one is the first again
  Handle neighbours[4];  ///< the same edges in the neighbours; the last one is not used
  double centre[2];
  double inner;
  double outer;
};
static_assert(sizeof(Triangle) == 64);

/// Triangles by handle.
class TriangleArray {
 public:
  /// Handles have 32 bits.
  static constexpr std::size_t kMaxTriangles = std::size_t{1} << 28;

  explicit TriangleArray(void* memory) : numbers_(static_cast<std::uint32_t*>(memory)) {}

  static constexpr int kNumberShift = 4;  ///< of a handle, to the triangle's number
  static constexpr Handle handle(std::uint32_t triangle, std::uint32_t slot) {
    return (triangle << kNumberShift) + slot;
  }
  /// That of the triangle's first vertex.
  static constexpr Handle first_handle(Handle h) { return h & ~Handle{15}; }
  /// The next vertex of the same triangle, counter-clockwise.
  static constexpr Handle next(Handle h) { return (h & ~Handle{3}) | (9U >> (2 * (h & 3)) & 3); }
  /// The vertex before.
  static constexpr Handle previous(Handle h) { return h + ((h & 3) == 0 ? 2 : Handle{0} - 1); }

  [[nodiscard]] VertexId vertex(Handle h) const { return numbers_[std::size_t{h}]; }
  /// vertex(next(h)), with less work.
  [[nodiscard]] VertexId next_vertex(Handle h) const { return numbers_[std::size_t{h} + 1]; }
  [[nodiscard]] Handle mirror(Handle h) const { return numbers_[std::size_t{h} + 4]; }
  /// Sets the vertices of the triangle that begins here.
  void set_vertices(Handle first, VertexId a, VertexId b, VertexId c) const {
    std::uint32_t* const vertices = numbers_ + std::size_t{first};
    vertices[0] = a;
    vertices[1] = b;
    vertices[2] = c;
    vertices[3] = a;
  }
  void join(Handle g, Handle h) const {
    numbers_[std::size_t{g} + 4] = h;
    numbers_[std::size_t{h} + 4] = g;
  }
  /// The triangle that begins here.
  [[nodiscard]] Triangle& at_first(Handle first) const {
    return *reinterpret_cast<Triangle*>(numbers_ + std::size_t{first});
  }
  /// The triangle of this number.
  [[nodiscard]] Triangle& record(std::uint32_t triangle) const {
    return at_first(handle(triangle, 0));
  }
  [[nodiscard]] Triangle& at(Handle h) const { return at_first(first_handle(h)); }

 private:
  std::uint32_t* numbers_;
};

}  // namespace spillway::delaunay::kernel_2d
