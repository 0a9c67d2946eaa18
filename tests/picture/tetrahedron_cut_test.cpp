#include "src/picture/tetrahedron_cut.h"

#include <gtest/gtest.h>

#include <cmath>
#include <utility>
#include <vector>

namespace spillway::test {
namespace {

using Tetrahedron = std::array<Point<3>, 4>;

double area(const PlaneCut& cut) {
  double doubled = 0;
  for (int i = 0; i < cut.count; ++i) {
    const Point<2>& a = cut.corners[i];
    const Point<2>& b = cut.corners[(i + 1) % cut.count];
    doubled += a[0] * b[1] - b[0] * a[1];
  }
  return std::abs(doubled) / 2;
}

/// The unit cube at a height as the six tetrahedra along its diagonal.
std::vector<Tetrahedron> cube(double z) {
  std::vector<Tetrahedron> tetrahedra;
  for (const auto& [a, b] : {std::pair{0, 1}, {0, 2}, {1, 0}, {1, 2}, {2, 0}, {2, 1}}) {
    Tetrahedron t;
    t[0] = {0, 0, z};
    t[1] = t[0];
    t[1][a] += 1;
    t[2] = t[1];
    t[2][b] += 1;
    t[3] = {1, 1, z + 1};
    tetrahedra.push_back(t);
  }
  return tetrahedra;
}

TEST(TetrahedronCut, CutsOfACubeAddUpToItsSquareOnEachAxis) {
  for (int axis = 0; axis < 3; ++axis) {
    for (const double value : {0.001, 0.3, 0.5, 0.9, 1.0}) {
      double sum = 0;
      for (const Tetrahedron& t : cube(0)) sum += area(cut(t, {axis, value}));
      EXPECT_NEAR(sum, 1, 1e-12) << axis << ' ' << value;
    }
  }
}

TEST(TetrahedronCut, AFaceOnThePlaneIsCutOnce) {
  double sum = 0;
  for (const double z : {0.0, 1.0}) {
    for (const Tetrahedron& t : cube(z)) sum += area(cut(t, {2, 1}));
  }
  EXPECT_NEAR(sum, 1, 1e-12);
}

TEST(TetrahedronCut, BesideThePlaneThereIsNone) {
  for (const Tetrahedron& t : cube(0)) {
    EXPECT_EQ(cut(t, {2, -0.1}).count, 0);
    EXPECT_EQ(cut(t, {2, 1.1}).count, 0);
  }
}

TEST(TetrahedronCut, ACornerDependsOnItsEdgeAlone) {
  const Tetrahedron t = {{{0.1, 0.2, 0.3}, {1.7, 0.4, 0.9}, {0.6, 1.3, 0.8}, {0.5, 0.7, -1.1}}};
  const PlaneCut one = cut(t, {2, 0});
  const PlaneCut other = cut({t[3], t[2], t[1], t[0]}, {2, 0});
  ASSERT_EQ(one.count, 3);
  ASSERT_EQ(other.count, 3);
  for (int i = 0; i < 3; ++i) EXPECT_EQ(one.corners[i], other.corners[2 - i]);
}

TEST(TetrahedronCut, AVertexOnThePlaneIsACornerToTheLastBit) {
  const Tetrahedron t = {{{0.1, 0.7, 0.3}, {1.7, 0.4, 0.9}, {0.6, 1.3, 0.8}, {0.5, 0.7, -1.1}}};
  const PlaneCut found = cut(t, {2, 0.3});
  ASSERT_EQ(found.count, 3);
  EXPECT_EQ(found.corners[0], (Point<2>{0.1, 0.7}));
}

}  // namespace
}  // namespace spillway::test
