#include "src/terrain/triangle_location.h"

#include <cmath>
#include <utility>

#include "src/geometry/predicate_stages.h"
#include "src/geometry/predicates.h"

namespace spillway::terrain {
namespace {

/// Products between these are rounded by remainders that are doubles themselves.
constexpr double kSmallestProduct = 0x1p-900;
constexpr double kLargestProduct = 0x1p1000;

bool has_exact_remainder(double product) {
  return std::abs(product) > kSmallestProduct && std::abs(product) < kLargestProduct;
}

/// orientation<2>() of a, b, p. Where the differences are exact, and they are on lattices and for
/// decimals of few digits, the products decide, since rounding is monotone: the rounded ones are in
/// the order of the true ones unless equal, and then their exact remainders tell. This is quick
/// also for points that lie on the line, as those of gridded input do.
int side(const Point<3>& a, const Point<3>& b, double x, double y) {
  const double dx = b[0] - a[0];
  const double dy = b[1] - a[1];
  const double px = x - a[0];
  const double py = y - a[1];
  if (stages::exact_difference(b[0], a[0], dx) && stages::exact_difference(b[1], a[1], dy) &&
      stages::exact_difference(x, a[0], px) && stages::exact_difference(y, a[1], py)) {
    const double left = dx * py;
    const double right = dy * px;
    if (left != right) return left > right ? 1 : -1;
    if ((dx == 0 || py == 0) && (dy == 0 || px == 0)) return 0;
    if (has_exact_remainder(left)) {
      return stages::sign(std::fma(dx, py, -left) - std::fma(dy, px, -right));
    }
  }
  return orientation<2>({Point<2>{a[0], a[1]}, Point<2>{b[0], b[1]}, Point<2>{x, y}});
}

/// The edges of a triangle, by their corners.
constexpr std::array<std::array<int, 2>, 3> kEdges = {{{0, 1}, {0, 2}, {1, 2}}};

/// Which of kEdges a point lies on, as bits, and what relation that is; 0 edges: inside.
constexpr std::array<TriangleRelation, 7> kRelationOfEdges = {
    TriangleRelation::kInside,  TriangleRelation::kEdge01, TriangleRelation::kEdge02,
    TriangleRelation::kCorner0, TriangleRelation::kEdge12, TriangleRelation::kCorner1,
    TriangleRelation::kCorner2};

}  // namespace

Triangle in_canonical_order(const Triangle& triangle) {
  Triangle sorted = triangle;
  const auto below = [](const Point<3>& a, const Point<3>& b) {
    return a[0] < b[0] || (a[0] == b[0] && a[1] < b[1]);
  };
  if (below(sorted[1], sorted[0])) std::swap(sorted[0], sorted[1]);
  if (below(sorted[2], sorted[1])) std::swap(sorted[1], sorted[2]);
  if (below(sorted[1], sorted[0])) std::swap(sorted[0], sorted[1]);
  return sorted;
}

int turn_of(const Triangle& canonical) {
  return side(canonical[0], canonical[1], canonical[2][0], canonical[2][1]);
}

std::optional<TriangleLocation> locate(const Triangle& canonical, int turn, double x, double y) {
  unsigned on_edges = 0;
  bool owned = true;
  for (int e = 0; e < 3; ++e) {
    const Point<3>& from = canonical[kEdges[e][0]];
    const Point<3>& to = canonical[kEdges[e][1]];
    // The triangle lies on one side of 0-1 and 1-2 and on the other of 0-2.
    const int inside = e == 1 ? -turn : turn;
    const int sign = side(from, to, x, y);
    if (sign == -inside) return std::nullopt;
    if (sign != 0) continue;
    on_edges |= 1U << e;
    // The side that the point is on when moved east or, along a horizontal edge, north.
    const int moved = to[1] > from[1] ? -1 : 1;
    owned = owned && moved == inside;
  }
  return TriangleLocation{kRelationOfEdges[on_edges], owned};
}

}  // namespace spillway::terrain
