#include "src/delaunay/base_case/affine_basis.h"

#include "src/geometry/predicates.h"

namespace spillway::delaunay {
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

}  // namespace

template <int D>
bool is_independent(std::span<const Point<D>> basis, const Point<D>& p) {
  if (basis.empty()) return true;
  if (basis.size() == 1) return p != basis[0];
  if (basis.size() == 2) return !collinear<D>(basis[0], basis[1], p);
  if constexpr (D == 3) return orientation<3>({basis[0], basis[1], basis[2], p}) != 0;
  return false;
}

template <int D>
std::vector<VertexId> affine_basis(std::span<const Point<D>> points) {
  std::vector<VertexId> basis;
  std::vector<Point<D>> members;
  for (VertexId i = 0; i < points.size() && basis.size() <= D; ++i) {
    if (!is_independent<D>(members, points[i])) continue;
    basis.push_back(i);
    members.push_back(points[i]);
  }
  return basis;
}

template std::vector<VertexId> affine_basis<2>(std::span<const Point<2>>);
template std::vector<VertexId> affine_basis<3>(std::span<const Point<3>>);
template bool is_independent<2>(std::span<const Point<2>>, const Point<2>&);
template bool is_independent<3>(std::span<const Point<3>>, const Point<3>&);

}  // namespace spillway::delaunay
