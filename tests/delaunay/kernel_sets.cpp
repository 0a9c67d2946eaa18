#include "tests/delaunay/kernel_sets.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "src/delaunay/base_case/affine_basis.h"
#include "src/delaunay/base_case/base_case.h"
#include "src/delaunay/kernel_2d/kernel_2d.h"
#include "src/delaunay/kernel_3d/kernel_3d.h"
#include "src/delaunay/kernel_common/hilbert_order.h"
#include "src/generators/random.h"
#include "tests/delaunay/cgal_oracle.h"
#include "tests/delaunay/verify.h"

namespace spillway::test {
namespace {

template <int D>
using Points = std::vector<Point<D>>;

double integer_below(Random& random, std::uint64_t n) {
  return static_cast<double>(random.below(n));
}

/// A point whose coordinates are the results of calls.
template <int D, typename Coordinate>
Point<D> point_of(const Coordinate& coordinate) {
  Point<D> p;
  for (double& c : p) c = coordinate();
  return p;
}

template <int D>
void add_lattice(Random& random, Points<D>& points, std::size_t count) {
  std::array<std::uint64_t, D> sides;
  for (std::uint64_t& side : sides) side = 1 + random.below(D == 2 ? 7 : 5);
  for (std::size_t i = 0; i < count; ++i) {
    Point<D>& p = points.emplace_back();
    for (int k = 0; k < D; ++k) p[k] = integer_below(random, sides[k]);
  }
}

template <int D>
void add_line(Random& random, Points<D>& points, std::size_t count) {
  const auto direction = point_of<D>([&] { return integer_below(random, 4) - 1; });
  for (std::size_t i = 0; i < count; ++i) {
    const double t = integer_below(random, 20);
    Point<D>& p = points.emplace_back();
    for (int k = 0; k < D; ++k) p[k] = t * direction[k];
  }
}

/// In space a lattice in a plane through the origin, often with a point beside it.
template <int D>
void add_plane(Random& random, Points<D>& points, std::size_t count) {
  const auto u = point_of<D>([&] { return integer_below(random, 3) - 1; });
  const auto v = point_of<D>([&] { return integer_below(random, 3) - 1; });
  for (std::size_t i = 0; i < count; ++i) {
    const double s = integer_below(random, 6);
    const double t = integer_below(random, 6);
    Point<D>& p = points.emplace_back();
    for (int k = 0; k < D; ++k) p[k] = s * u[k] + t * v[k];
  }
  if (random.below(2) == 0) add_lattice<D>(random, points, 1);
}

/// Points with integer coordinates on one circle or sphere around the origin, sometimes with its
/// centre.
template <int D>
void add_integer_sphere(Random& random, Points<D>& points, std::size_t count) {
  constexpr std::array<int, 5> kCircles{5, 25, 65, 325, 1105};
  constexpr std::array<int, 5> kSpheres{3, 9, 15, 21, 27};
  const int radius = (D == 2 ? kCircles : kSpheres)[random.below(5)];
  Points<D> sphere;
  const auto add_with_last = [&](Point<D> p, int squared_last) {
    const int last = static_cast<int>(std::lround(std::sqrt(squared_last)));
    if (squared_last < 0 || last * last != squared_last) return;
    for (const int sign : {-1, 1}) {
      p[D - 1] = sign * last;
      sphere.push_back(p);
    }
  };
  for (int x = -radius; x <= radius; ++x) {
    const int rest = radius * radius - x * x;
    if constexpr (D == 2) {
      add_with_last({static_cast<double>(x)}, rest);
    } else {
      for (int y = -radius; y <= radius; ++y) {
        add_with_last({static_cast<double>(x), static_cast<double>(y)}, rest - y * y);
      }
    }
  }
  for (std::size_t i = 0; i < count; ++i) points.push_back(sphere[random.below(sphere.size())]);
  if (random.below(2) == 0) points.push_back({});
}

/// As near to a circle or sphere as doubles are, or some roundings off.
template <int D>
void add_rounded_sphere(Random& random, Points<D>& points, std::size_t count) {
  const std::uint64_t roundings = random.below(4);
  for (std::size_t i = 0; i < count; ++i) {
    const double angle = 2 * std::numbers::pi * integer_below(random, 64) / 64;
    Point<D> p{std::cos(angle), std::sin(angle)};
    if constexpr (D == 3) {
      const double height = std::numbers::pi * integer_below(random, 16) / 16;
      p = {p[0] * std::sin(height), p[1] * std::sin(height), std::cos(height)};
    }
    for (double& c : p) c *= 1 + integer_below(random, roundings + 1) * 0x1p-52;
    points.push_back(p);
  }
}

template <int D>
void add_decimals(Random& random, Points<D>& points, std::size_t count) {
  for (std::size_t i = 0; i < count; ++i) {
    points.push_back(point_of<D>([&] { return integer_below(random, 8) * 0.1; }));
  }
}

template <int D>
void add_uniform(Random& random, Points<D>& points, std::size_t count) {
  for (std::size_t i = 0; i < count; ++i) {
    points.push_back(point_of<D>([&] { return random.uniform(); }));
  }
}

/// Corners of a large square or cube beside the points of a small one.
template <int D>
void add_two_scales(Random& random, Points<D>& points, std::size_t count) {
  constexpr double kEnd = 0x1p31;
  for (std::size_t i = 0; i < count; ++i) {
    const bool corner = random.below(3) == 0;
    points.push_back(point_of<D>([&] {
      const double small = integer_below(random, 4);
      return !corner ? small : small < 2 ? -kEnd : kEnd - 1;
    }));
  }
}

template <int D>
void transform(Random& random, Points<D>& points) {
  constexpr std::array<double, 5> kOffsets{1e6, 1e9, 1e12, 1e15, -3e5};
  constexpr std::array<int, 7> kExponents{-1074, -1060, -500, -30, 30, 500, 950};
  if (random.below(3) == 0) {
    const auto offset = point_of<D>([&] { return kOffsets[random.below(kOffsets.size())]; });
    for (Point<D>& p : points) {
      for (int k = 0; k < D; ++k) p[k] += offset[k];
    }
  }
  if (random.below(3) == 0) {
    const int exponent = kExponents[random.below(kExponents.size())];
    for (Point<D>& p : points) {
      for (double& c : p) c = std::ldexp(c, exponent);
    }
  }
  if (random.below(4) == 0) {
    for (Point<D>& p : points) std::swap(p[0], p[D - 1]);
  }
}

BaseCase<2> run_kernel(const BaseCaseInput<2>& input, std::span<const VertexId> basis) {
  return kernel_2d_base_case(input, basis);
}

BaseCase<3> run_kernel(const BaseCaseInput<3>& input, std::span<const VertexId> basis) {
  return kernel_3d_base_case(input, basis);
}

/// The finite simplices as CGAL's oracle names them: by sorted places in `points`, of equal points
/// the first.
template <int D>
std::vector<std::array<VertexId, D + 1>> finite_simplices(const BaseCase<D>& base_case,
                                                          std::span<const VertexId> place) {
  std::vector<std::array<VertexId, D + 1>> simplices;
  for (const Simplex<D>& s : base_case.simplices) {
    if (s.infinite()) continue;
    auto& simplex = simplices.emplace_back();
    for (int i = 0; i <= D; ++i) simplex[i] = place[s.vertices[i]];
    std::sort(simplex.begin(), simplex.end());
  }
  std::sort(simplices.begin(), simplices.end());
  return simplices;
}

}  // namespace

template <int D>
std::vector<Point<D>> hard_set(std::uint64_t seed) {
  constexpr std::array kParts{add_lattice<D>,        add_line<D>,     add_integer_sphere<D>,
                              add_rounded_sphere<D>, add_decimals<D>, add_uniform<D>,
                              add_two_scales<D>,     add_plane<D>};
  Random random(seed);
  Points<D> points;
  const std::uint64_t parts = 1 + random.below(2);
  for (std::uint64_t part = 0; part < parts; ++part) {
    kParts[random.below(kParts.size())](random, points, 1 + random.below(30));
  }
  transform<D>(random, points);
  return points;
}

template <int D>
std::string compare_kernel_with_cgal(std::span<const Point<D>> points, std::uint64_t seed) {
  // Half of the sets in the order of the curve, as the kernel likes it, half as they come.
  std::vector<VertexId> place(points.size());
  std::iota(place.begin(), place.end(), VertexId{0});
  if (seed % 2 == 0) {
    Box<D> box;
    for (const Point<D>& p : points) box.expand(p);
    place = hilbert_order<D>(points, box);
  }
  Triangulation<D> t;
  t.points = SlabArray<Point<D>>(points.size());
  t.input_index = SlabArray<VertexId>(points.size());
  std::transform(place.begin(), place.end(), t.points.begin(),
                 [&](VertexId i) { return points[i]; });
  std::copy(place.begin(), place.end(), t.input_index.begin());
  const BaseCaseInput<D> input{
      .points = t.points, .input_index = t.input_index, .in_place = seed % 4 >= 2};
  const std::vector<VertexId> basis = affine_basis<D>(input.points);
  const auto expected = cgal_simplices<D>(points);
  if (basis.size() <= D) return expected.empty() ? "" : "flat points have simplices";
  BaseCase<D> result = run_kernel(input, basis);
  if (finite_simplices<D>(result, place) != expected) {
    return fmt::format("{} finite simplices, CGAL has {}, or others",
                       result.simplices.size() - result.hull.size(), expected.size());
  }
  t.lists.resize(1);
  t.lists[0].simplices = std::move(result.simplices);
  for (const std::uint32_t i : result.hull) t.hull.push_back({0, i});
  t.duplicates = result.duplicates;
  t.dimension = D;
  const std::vector<std::string> faults = verify(t);
  recycle(std::move(t.lists[0].simplices));
  return faults.empty() ? "" : faults.front();
}

template std::vector<Point<2>> hard_set<2>(std::uint64_t);
template std::vector<Point<3>> hard_set<3>(std::uint64_t);
template std::string compare_kernel_with_cgal<2>(std::span<const Point<2>>, std::uint64_t);
template std::string compare_kernel_with_cgal<3>(std::span<const Point<3>>, std::uint64_t);

}  // namespace spillway::test
