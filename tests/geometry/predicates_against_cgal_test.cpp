// The predicates against CGAL's: exact rational arithmetic, and the symbolic perturbation of its
// Delaunay triangulations, which the canonical triangulation is defined by.

#include <CGAL/Delaunay_triangulation_2.h>
#include <CGAL/Delaunay_triangulation_3.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Exact_rational.h>
#include <CGAL/Simple_cartesian.h>
#include <gtest/gtest.h>

#include "src/geometry/predicates.h"
#include "tests/geometry/point_families.h"

namespace spillway::test {
namespace {

using Exact = CGAL::Simple_cartesian<CGAL::Exact_rational>;
using Filtered = CGAL::Exact_predicates_inexact_constructions_kernel;

template <typename Kernel, int D>
struct Oracle;

template <typename Kernel>
struct Oracle<Kernel, 2> {
  static auto convert(const Point<2>& p) { return typename Kernel::Point_2(p[0], p[1]); }
  static int orientation(const std::array<Point<2>, 3>& s) {
    return CGAL::orientation(convert(s[0]), convert(s[1]), convert(s[2]));
  }
  static int in_sphere(const std::array<Point<2>, 3>& s, const Point<2>& q) {
    static const CGAL::Delaunay_triangulation_2<Kernel> kTriangulation;
    return kTriangulation.side_of_oriented_circle(convert(s[0]), convert(s[1]), convert(s[2]),
                                                  convert(q), true);
  }
};

// side_of_oriented_sphere is a protected member.
template <typename Kernel>
class OpenDelaunay3 : public CGAL::Delaunay_triangulation_3<Kernel> {
 public:
  using CGAL::Delaunay_triangulation_3<Kernel>::side_of_oriented_sphere;
};

template <typename Kernel>
struct Oracle<Kernel, 3> {
  static auto convert(const Point<3>& p) { return typename Kernel::Point_3(p[0], p[1], p[2]); }
  static int orientation(const std::array<Point<3>, 4>& s) {
    return CGAL::orientation(convert(s[0]), convert(s[1]), convert(s[2]), convert(s[3]));
  }
  static int in_sphere(const std::array<Point<3>, 4>& s, const Point<3>& q) {
    static const OpenDelaunay3<Kernel> kTriangulation;
    return kTriangulation.side_of_oriented_sphere(convert(s[0]), convert(s[1]), convert(s[2]),
                                                  convert(s[3]), convert(q), true);
  }
};

template <int D>
class AgainstCgal {
 public:
  template <typename Kernel>
  static void compare(const Group<D>& group) {
    auto simplex = simplex_of<D>(group);
    const Point<D>& query = group[D + 1];
    const int o = orientation<D>(simplex);
    ASSERT_EQ(o, (Oracle<Kernel, D>::orientation(simplex)));
    if (o == 0 || std::find(simplex.begin(), simplex.end(), query) != simplex.end()) return;
    if (o < 0) std::swap(simplex[0], simplex[1]);
    ASSERT_EQ(in_sphere<D>(simplex, query), (Oracle<Kernel, D>::in_sphere(simplex, query)));
  }
};

template <typename Dimension>
class PredicatesAgainstCgalTest : public ::testing::Test {};
using Dimensions = ::testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 3>>;
TYPED_TEST_SUITE(PredicatesAgainstCgalTest, Dimensions);

TYPED_TEST(PredicatesAgainstCgalTest, HardPointsGetTheSameAnswers) {
  constexpr int D = TypeParam::value;
  for (const Hard family : kAllHard) {
    SCOPED_TRACE(name_of(family));
    for (const Group<D>& group : hard_groups<D>(family, 1000, 11)) {
      AgainstCgal<D>::template compare<Exact>(group);
      AgainstCgal<D>::template compare<Filtered>(group);
      if (::testing::Test::HasFatalFailure()) return;
    }
  }
}

TEST(PredicatesAgainstCgal2DTest, EveryTripleAndQueryOnASmallGridIsPerturbedAlike) {
  constexpr int kSide = 4;
  constexpr int kCount = kSide * kSide;
  const auto at = [](int i) { return Point<2>{double(i % kSide), double(i / kSide)}; };
  for (int code = 0; code < kCount * kCount * kCount * kCount; ++code) {
    const Group<2> group{at(code % kCount), at(code / kCount % kCount),
                         at(code / (kCount * kCount) % kCount),
                         at(code / (kCount * kCount * kCount))};
    AgainstCgal<2>::compare<Filtered>(group);
    ASSERT_FALSE(HasFatalFailure());
  }
}

TEST(PredicatesAgainstCgal3DTest, EverySimplexAndQueryOfACubeIsPerturbedAlike) {
  const auto at = [](int i) {
    return Point<3>{double(i & 1), double(i >> 1 & 1), double(i >> 2 & 1)};
  };
  for (int code = 0; code < 8 * 8 * 8 * 8 * 8; ++code) {
    const Group<3> group{at(code & 7), at(code >> 3 & 7), at(code >> 6 & 7), at(code >> 9 & 7),
                         at(code >> 12)};
    AgainstCgal<3>::compare<Filtered>(group);
    ASSERT_FALSE(HasFatalFailure());
  }
}

}  // namespace
}  // namespace spillway::test
