// Triangulations of points that repeat, through the door for programs.

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <spillway/check.h>
#include <spillway/convert.h>
#include <spillway/triangulate.h>

#include <cmath>
#include <filesystem>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include "src/error.h"

namespace spillway {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

PeriodicBox cube(double low, double high) { return {.box = {{low, low, low}, {high, high, high}}}; }

std::vector<Point<3>> random_points(std::size_t count, const PeriodicBox& box,
                                    std::uint64_t seed = 1) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> share(0, 1);
  std::vector<Point<3>> points(count);
  for (auto& point : points) {
    for (int k = 0; k < 3; ++k) point[k] = box.box.low[k] + share(random) * box.period(k);
  }
  return points;
}

/// The same, moved to multiples of 2^-40: so sums with periods are exact.
std::vector<Point<3>> dyadic_points(std::size_t count, const PeriodicBox& box) {
  std::vector<Point<3>> points = random_points(count, box);
  for (auto& point : points) {
    for (double& x : point) x = std::ldexp(std::floor(std::ldexp(x, 40)), -40);
  }
  return points;
}

/// Points of a cubic lattice with so many steps a side.
std::vector<Point<3>> lattice(int steps, double spacing, int axes) {
  std::vector<Point<3>> points;
  for (int x = 0; x < steps; ++x) {
    for (int y = 0; y < steps; ++y) {
      for (int z = 0; z < (axes == 3 ? steps : 1); ++z) {
        points.push_back({x * spacing, y * spacing, z * spacing});
      }
    }
  }
  return points;
}

class Periodic : public ::testing::TestWithParam<int> {
 protected:
  Periodic() {
    std::string name = ::testing::TempDir() + "spillway-test-periodic-XXXXXX";
    if (::mkdtemp(name.data()) != nullptr) folder_ = name;
  }
  ~Periodic() override { fs::remove_all(folder_); }

  [[nodiscard]] std::string path(const std::string& name) const { return folder_ + "/" + name; }

  [[nodiscard]] ContextOptions options() const {
    ContextOptions options;
    options.memory = 256 << 20;
    options.threads = 2;
    options.scratch_folder = folder_;
    return options;
  }

  /// Writes the mesh, proves it, and returns its totals.
  Report proved(const std::vector<Point<3>>& points, const PeriodicBox& box,
                TriangulateOptions how = {}) {
    how.dimension = GetParam();
    how.periodic = box;
    ContextOptions told = options();
    told.detail = [this](std::string_view text) { detail_ += std::string(text) + "\n"; };
    const Context context(told);
    const auto source = points_in_memory(PointView<3>(points), {});
    const Report report =
        triangulate(*source, *create_mesh(path("mesh.spm"), {}, context), how, context);
    const CheckReport proof = check(*open_mesh(path("mesh.spm"), {}, context), {}, context);
    EXPECT_EQ(proof.fault_count, 0U) << (proof.faults.empty() ? "" : proof.faults[0]);
    const auto same = points_in_memory(PointView<3>(points), {});
    EXPECT_EQ(check(*open_mesh(path("mesh.spm"), {}, context), {}, context, same.get()).fault_count,
              0U)
        << "the vertices are other points";
    EXPECT_EQ(proof.canonical_hash, report.mesh.canonical_hash);
    EXPECT_EQ(proof.vertices, report.mesh.vertices);
    EXPECT_EQ(proof.simplices, report.mesh.simplices);
    EXPECT_EQ(proof.hull_facets, report.mesh.hull_facets);
    return report;
  }

  /// The text of what triangulating throws.
  std::string refusal(const std::vector<Point<3>>& points, const PeriodicBox& box,
                      TriangulateOptions how = {}) {
    how.dimension = GetParam();
    how.periodic = box;
    const Context context(options());
    const auto source = points_in_memory(PointView<3>(points), {});
    MeshInMemory mesh;
    try {
      triangulate(*source, mesh, how, context);
    } catch (const Error& error) {
      code_ = error.code();
      return error.what();
    }
    return "nothing";
  }

  std::string folder_;
  std::string detail_;
  ErrorCode code_{};
};

TEST_P(Periodic, RandomPointsAreProvedAndPlanesHaveTwoTrianglesAVertex) {
  const PeriodicBox box = cube(-3, 5);
  const Report report = proved(random_points(3000, box), box);
  EXPECT_EQ(report.mesh.vertices, 3000U);
  EXPECT_EQ(report.mesh.hull_facets, 0U);
  if (GetParam() == 2) {
    EXPECT_EQ(report.mesh.simplices, 6000U);
  }
}

TEST_P(Periodic, TheResultDoesNotDependOnHowTheWorkIsDivided) {
  const PeriodicBox box = cube(0, 1);
  const std::vector<Point<3>> points = random_points(20'000, box);
  const std::uint64_t hash = proved(points, box).mesh.canonical_hash;
  EXPECT_EQ(proved(points, box, {.tile_points = 3000, .leaf_points = 300}).mesh.canonical_hash,
            hash);
  std::vector<Point<3>> reversed(points.rbegin(), points.rend());
  EXPECT_EQ(proved(reversed, box, {.tile_points = 5000, .children = 8}).mesh.canonical_hash, hash);
}

TEST_P(Periodic, MovingPointsByPeriodsChangesNothing) {
  const PeriodicBox box = cube(0, 2);
  std::vector<Point<3>> points = dyadic_points(2000, box);
  const Report report = proved(points, box);
  EXPECT_EQ(report.points.wrapped, 0U);
  std::mt19937_64 random(7);
  for (auto& point : points) {
    for (int k = 0; k < GetParam(); ++k) point[k] += 2.0 * static_cast<int>(random() % 9 - 4);
  }
  const Report moved = proved(points, box);
  EXPECT_EQ(moved.mesh.canonical_hash, report.mesh.canonical_hash);
  EXPECT_GT(moved.points.wrapped, 1000U);
  EXPECT_THAT(describe(moved.points), HasSubstr("brought into the periodic box"));
}

TEST_P(Periodic, MovingTheBoxByAPeriodChangesNoSimplex) {
  std::vector<Point<3>> points = dyadic_points(2000, cube(0, 1));
  const Report report = proved(points, cube(0, 1));
  const Report moved = proved(points, cube(1, 2));
  EXPECT_EQ(moved.mesh.simplices, report.mesh.simplices);
  for (auto& point : points) {
    for (int k = 0; k < GetParam(); ++k) point[k] += 1;
  }
  EXPECT_EQ(proved(points, cube(1, 2)).mesh.canonical_hash, moved.mesh.canonical_hash);
}

TEST_P(Periodic, ALatticeIsTheSameWhereverItsBoxBegins) {
  const int steps = 7;
  const std::vector<Point<3>> points = lattice(steps, 1, GetParam());
  const Report report = proved(points, cube(0, steps));
  EXPECT_EQ(report.mesh.simplices,
            points.size() * (GetParam() == 2 ? 2U : 6U));  // a cube falls into 6 tetrahedra here
  // By whole steps the lattice moves onto itself.
  EXPECT_EQ(proved(points, cube(3, 3 + steps)).mesh.simplices, report.mesh.simplices);
  std::vector<Point<3>> moved = points;
  for (auto& point : moved) {
    for (int k = 0; k < GetParam(); ++k) point[k] += 3;
  }
  EXPECT_EQ(proved(moved, cube(0, steps)).mesh.canonical_hash, report.mesh.canonical_hash);
}

TEST_P(Periodic, ALatticeOfDecimalsIsRoundedToWhereCopiesAreExact) {
  const std::vector<Point<3>> points = lattice(10, 0.1, GetParam());
  const Report report = proved(points, cube(0, 1));
  EXPECT_EQ(report.mesh.vertices, points.size());
  EXPECT_GT(report.points.rounded, 0U);
}

TEST_P(Periodic, SidesThatAreOpenAreProvedToo) {
  for (int open = 0; open < GetParam(); ++open) {
    PeriodicBox box = cube(0, 1);
    const std::vector<Point<3>> points = random_points(1500, box);
    box.periodic[static_cast<std::size_t>(open)] = false;
    const Report report = proved(points, box);
    EXPECT_GT(report.mesh.hull_facets, 0U);
  }
  if (GetParam() == 2) return;
  PeriodicBox box = cube(0, 1);
  const std::vector<Point<3>> points = random_points(1500, box);
  box.periodic = {false, true, false};
  EXPECT_GT(proved(points, box).mesh.hull_facets, 0U);
}

TEST_P(Periodic, OpenLatticesHaveTwoFlatSides) {
  PeriodicBox box = cube(0, 5);
  box.periodic[1] = false;
  const Report report = proved(lattice(5, 1, GetParam()), box);
  EXPECT_EQ(report.mesh.hull_facets, GetParam() == 2 ? 10U : 100U);
}

TEST_P(Periodic, FewPointsOfASmallGridBetweenOpenSidesAreProved) {
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    std::mt19937_64 random(seed);
    std::vector<Point<3>> points(6 + random() % 30);
    for (auto& point : points) {
      for (double& x : point) x = static_cast<double>(random() % 8);
    }
    PeriodicBox box = cube(0, 8);
    for (int k = 0; k < GetParam(); ++k) box.periodic[static_cast<std::size_t>(k)] = false;
    box.periodic[seed % static_cast<std::uint64_t>(GetParam())] = true;
    if (GetParam() == 3 && seed % 2 == 0) box.periodic[(seed + 1) % 3] = true;
    proved(points, box);
  }
}

TEST_P(Periodic, CrystalsWithVacanciesBetweenOpenSidesAreProved) {
  for (const double spacing : {4.05, 2.87, 0.1, 1.0 / 3}) {
    for (std::uint64_t seed = 1; seed <= 8; ++seed) {
      std::mt19937_64 random(seed);
      std::vector<Point<3>> points = lattice(5, spacing, GetParam());
      std::erase_if(points, [&](const Point<3>&) { return random() % 5 == 0; });
      PeriodicBox box = cube(0, 5 * spacing);
      box.periodic[seed % static_cast<std::uint64_t>(GetParam())] = false;
      if (GetParam() == 3 && seed % 2 == 0) box.periodic[(seed + 1) % 3] = false;
      proved(points, box);
    }
  }
}

TEST_P(Periodic, NearlyFlatFacetsOfAPrismAreProved) {
  if (GetParam() == 2) GTEST_SKIP() << "there are prisms in space only";
  std::mt19937_64 random(5);
  for (int i = 0; i < 300; ++i) {
    std::vector<Point<3>> points(3 + random() % 4);
    for (auto& point : points) {
      for (double& x : point) x = static_cast<double>(random() % 20) * 0.1;
    }
    PeriodicBox box = cube(0, 2);
    box.periodic = {i % 3 == 0, i % 3 == 1, i % 3 == 2};
    const std::string text = refusal(points, box);
    // Points in one plane along the axis are refused, and nothing else is.
    if (text == "nothing") {
      proved(points, box);
    } else {
      EXPECT_THAT(text, HasSubstr("lie on one line or in one plane"));
    }
  }
}

TEST_P(Periodic, SidesOfVeryDifferentLengthsEndSoon) {
  PeriodicBox box = cube(0, 1);
  box.box.high[1] = 1000;
  EXPECT_THAT(refusal(random_points(300, box), box), HasSubstr("too few points"));
  EXPECT_THAT(refusal(random_points(100, cube(0, 1)), cube(0, 1e-300)), HasSubstr("periods lie"));
  EXPECT_THAT(refusal(random_points(100, cube(0, 1)), cube(-1e308, 1e308)),
              HasSubstr("periods lie"));
}

TEST_P(Periodic, PointsOnOneLineAreTooFew) {
  std::vector<Point<3>> points;
  for (int i = 0; i < 300; ++i) points.push_back({i / 300.0, 0.5, 0.5});
  EXPECT_THAT(refusal(points, cube(0, 1)), HasSubstr("too few points"));
  EXPECT_THAT(refusal(std::vector<Point<3>>(500, Point<3>{0.5, 0.5, 0.5}), cube(0, 1)),
              HasSubstr("too few points"));
}

TEST_P(Periodic, AMarginThatIsTooNarrowIsWidened) {
  // Most points lie far from the sides, and only some in the void there.
  const PeriodicBox box = cube(0, 1);
  std::vector<Point<3>> points = random_points(400, box);
  for (const Point<3>& point : random_points(20'000, cube(0.45, 0.55), 2)) points.push_back(point);
  proved(points, box);
  EXPECT_THAT(detail_, HasSubstr("was enough"));
}

TEST_P(Periodic, EqualPointsAreOneVertex) {
  const PeriodicBox box = cube(0, 1);
  std::vector<Point<3>> points = dyadic_points(1000, box);
  const std::size_t count = points.size();
  for (std::size_t i = 0; i < count; i += 10) {
    points.push_back(points[i]);
    points.back()[0] += 1;
  }
  const Report report = proved(points, box);
  EXPECT_EQ(report.mesh.points, points.size());
  EXPECT_EQ(report.mesh.vertices, count);
  EXPECT_EQ(report.mesh.duplicates, points.size() - report.mesh.vertices);
}

TEST_P(Periodic, ASinkOfTheProgramGetsOffsetsOfAllCorners) {
  const PeriodicBox box = cube(0, 1);
  const std::vector<Point<3>> points = random_points(2000, box);
  const Context context(options());
  TriangulateOptions how{.dimension = GetParam(), .input_index = true, .periodic = box};
  MeshInMemory mesh;
  triangulate(*points_in_memory(PointView<3>(points), {}), mesh, how, context);
  ASSERT_TRUE(mesh.header().periodic.has_value());
  EXPECT_EQ(*mesh.header().periodic->periodic.begin(), true);
  const auto axes = static_cast<std::size_t>(GetParam());
  ASSERT_EQ(mesh.offsets().size(), mesh.corners().size() * axes);
  ASSERT_EQ(mesh.vertices().size(), points.size());
  std::size_t across = 0;
  for (std::size_t c = 0; c < mesh.corners().size(); c += axes + 1) {
    // The offsets bring corners together: none is half a period from the first one.
    for (std::size_t i = 0; i <= axes; ++i) {
      for (std::size_t k = 0; k < axes; ++k) {
        const int offset = mesh.offsets()[(c + i) * axes + k];
        const double from = mesh.vertices()[mesh.corners()[c]][k];
        const double to = mesh.vertices()[mesh.corners()[c + i]][k] + offset;
        EXPECT_LT(std::abs(to - from), 0.5);
        if (i == 0) {
          EXPECT_EQ(offset, 0);
        }
        across += offset != 0 ? 1 : 0;
      }
    }
  }
  EXPECT_GT(across, 0U);
  for (std::size_t v = 0; v < points.size(); ++v) {
    EXPECT_NEAR(mesh.vertices()[v][0], points[mesh.input_index()[v]][0], 1e-15);
  }
}

TEST_P(Periodic, TooFewPointsAreRefusedWithWhatIsMissing) {
  for (const std::size_t count : {1U, 2U, 5U, 9U}) {
    EXPECT_THAT(refusal(random_points(count, cube(0, 1)), cube(0, 1)),
                HasSubstr("too few points for a triangulation of the periodic box"));
    EXPECT_EQ(code_, ErrorCode::kDegenerateInput);
  }
}

TEST_P(Periodic, AVoidOfHalfThePeriodIsRefused) {
  EXPECT_THAT(refusal(random_points(5000, cube(0.4, 0.6)), cube(0, 1)),
              HasSubstr("all must be shorter than half of it"));
}

TEST_P(Periodic, NoPointsAreRefused) {
  EXPECT_THAT(refusal({}, cube(0, 1)), HasSubstr("no points"));
}

TEST_P(Periodic, BoxesThatCannotBeAreRefused) {
  const std::vector<Point<3>> points = random_points(100, cube(0, 1));
  EXPECT_THAT(refusal(points, cube(1, 1)), HasSubstr("has no length along x"));
  EXPECT_EQ(code_, ErrorCode::kInvalidArgument);
  EXPECT_THAT(refusal(points, cube(0, INFINITY)), HasSubstr("has no length along x"));
  EXPECT_THAT(refusal(points, cube(1e16, 1e16 + 4)), HasSubstr("too short for doubles"));
  PeriodicBox open = cube(0, 1);
  open.periodic = {};
  EXPECT_THAT(refusal(points, open), HasSubstr("no periodic axis"));
}

TEST_P(Periodic, WhatHasNoMeaningOnATorusIsRefused) {
  const std::vector<Point<3>> points = random_points(100, cube(0, 1));
  EXPECT_THAT(refusal(points, cube(0, 1), {.max_edge = 0.1}), HasSubstr("longest edge"));
  EXPECT_THAT(refusal(points, cube(0, 1), {.resume_folder = path("state")}),
              HasSubstr("cannot go on"));
  const Context context(options());
  EXPECT_THROW(create_mesh(path("mesh.obj"), {}, context)
                   ->begin({.dimension = GetParam(), .periodic = cube(0, 1)}),
               Error);
}

TEST_P(Periodic, FilesAreReadTwiceAndLatticesStayWhatTheyAre) {
  const Context context(options());
  const Lattice steps{.scale = {0.01, 0.01, 0.01}, .offset = {100, 200, 300}};
  std::vector<Point<3>> points = random_points(3000, cube(0, 50));
  for (auto& point : points) {
    for (int k = 0; k < 3; ++k) {
      point[k] = steps.coordinate(k, std::floor(point[k] * 100));
    }
  }
  const PeriodicBox box{.box = {{100, 200, 300}, {150, 250, 350}}};
  auto sink =
      create_points(path("points.las"), {.scale = {0.01}, .offset = {100, 200, 300}}, context);
  convert(*points_in_memory(PointView<3>(points), {}), *sink, context);
  TriangulateOptions how{.dimension = GetParam(), .periodic = box};
  const auto source = open_points({path("points.las")}, {.dimension = GetParam()}, context);
  const Report report =
      triangulate(*source, *create_mesh(path("mesh.spm"), {}, context), how, context);
  EXPECT_TRUE(report.on_lattice);
  EXPECT_EQ(report.points.wrapped, 0U);
  EXPECT_EQ(report.points.rounded, 0U);
  const CheckReport proof = check(*open_mesh(path("mesh.spm"), {}, context), {}, context);
  EXPECT_EQ(proof.fault_count, 0U) << (proof.faults.empty() ? "" : proof.faults[0]);
  EXPECT_TRUE(proof.on_lattice);
  how.periodic->box.high[0] = 150.005;
  const auto again = open_points({path("points.las")}, {.dimension = GetParam()}, context);
  try {
    triangulate(*again, *create_mesh(path("mesh.spm"), {}, context), how, context);
    FAIL() << "a side between the lattice's steps was taken";
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), HasSubstr("lies between the steps of the points' lattice"));
  }
}

INSTANTIATE_TEST_SUITE_P(Dimensions, Periodic, ::testing::Values(2, 3), [](const auto& dimension) {
  return std::to_string(dimension.param) + "D";
});

}  // namespace
}  // namespace spillway
