#include "src/delaunay/base_case/affine_basis.h"

#include <algorithm>
#include <array>
#include <bit>

#include "src/geometry/dimensions.h"
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

/// Whether D points and one more span D dimensions.
template <int D>
bool spans_all_axes(std::span<const Point<D>> basis, const Point<D>& p) {
  std::array<Point<D>, D + 1> simplex;
  std::copy(basis.begin(), basis.end(), simplex.begin());
  simplex[D] = p;
  return orientation<D>(simplex) != 0;
}

/// The same of from N to D - 1 points: they are independent if their shadow on some axes, as many
/// as there are points, is.
template <int N, int D>
bool is_independent_in_shadow(std::span<const Point<D>> basis, const Point<D>& p) {
  if constexpr (N < D) {
    if (basis.size() != N) return is_independent_in_shadow<N + 1, D>(basis, p);
    for (unsigned axes = 0; axes < 1U << D; ++axes) {
      if (std::popcount(axes) != N) continue;
      const auto shadow = [axes](const Point<D>& point) {
        Point<N> result;
        for (int k = 0, n = 0; k < D; ++k) {
          if ((axes >> k & 1U) != 0) result[n++] = point[k];
        }
        return result;
      };
      std::array<Point<N>, N> shadows;
      std::transform(basis.begin(), basis.end(), shadows.begin(), shadow);
      if (spans_all_axes<N>(shadows, shadow(p))) return true;
    }
  }
  return false;
}

}  // namespace

template <int D>
bool is_independent(std::span<const Point<D>> basis, const Point<D>& p) {
  if (basis.empty()) return true;
  if (basis.size() == 1) return p != basis[0];
  if (basis.size() == 2) return !collinear<D>(basis[0], basis[1], p);
  if constexpr (D > 2) {
    if (basis.size() == D) return spans_all_axes<D>(basis, p);
  }
  if constexpr (D > 3) return is_independent_in_shadow<3, D>(basis, p);
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

#define SPILLWAY_INSTANTIATE(D)                                              \
  template std::vector<VertexId> affine_basis<D>(std::span<const Point<D>>); \
  template bool is_independent<D>(std::span<const Point<D>>, const Point<D>&);
SPILLWAY_FOR_EACH_DIMENSION(SPILLWAY_INSTANTIATE)
#undef SPILLWAY_INSTANTIATE

}  // namespace spillway::delaunay
