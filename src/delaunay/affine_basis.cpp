#include "src/delaunay/affine_basis.h"

#include "src/geometry/predicates.h"

namespace spillway {
namespace {

/// Points are collinear if their projections along every axis are.
template <int D>
bool collinear(const Point<D>& a, const Point<D>& b, const Point<D>& c) {
  for (int i = 0; i < D; ++i) {
    for (int j = 0; j < i; ++j) {
      if (orientation<2>({Point<2>{a[i], a[j]}, {b[i], b[j]}, {c[i], c[j]}}) != 0) return false;
    }
  }
  return true;
}

template <int D>
bool extends(std::span<const Point<D>> points, const std::vector<VertexId>& basis,
             const Point<D>& p) {
  const auto member = [&](std::size_t i) { return points[basis[i]]; };
  if (basis.empty()) return true;
  if (basis.size() == 1) return p != member(0);
  if (basis.size() == 2) return !collinear<D>(member(0), member(1), p);
  if constexpr (D == 3) return orientation<3>({member(0), member(1), member(2), p}) != 0;
  return false;
}

}  // namespace

template <int D>
std::vector<VertexId> affine_basis(std::span<const Point<D>> points) {
  std::vector<VertexId> basis;
  for (VertexId i = 0; i < points.size() && basis.size() <= D; ++i) {
    if (extends<D>(points, basis, points[i])) basis.push_back(i);
  }
  return basis;
}

template std::vector<VertexId> affine_basis<2>(std::span<const Point<2>>);
template std::vector<VertexId> affine_basis<3>(std::span<const Point<3>>);

}  // namespace spillway
