// The scan: points on the surfaces of a scene that a station sees, and nothing behind them.

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>
#include <vector>

#include <gtest/gtest.h>

#include "src/generators/generators.h"
#include "src/generators/scan_scene.h"

namespace spillway::test {
namespace {

/// Six standard deviations of the noise at the end of the range, and what the bilinear ground and
/// its profile along a column differ by.
constexpr double kTolerance = 0.03;

std::vector<Point<3>> scan(std::uint64_t count, std::uint64_t seed) {
  auto points = generated_points<3>({Family::kScan, count, 3, seed});
  for (Point<3>& p : points) {
    for (double& x : p) x *= 0.0001;
  }
  return points;
}

struct Depths {
  double walls, roof;
};

/// How deep a point is below the roof's planes and behind the walls, each the least of them.
Depths depths_in(const ScanBuilding& b, const Point<3>& p) {
  const double dx = p[0] - b.x;
  const double dy = p[1] - b.y;
  const double along = dx * b.along.cosine + dy * b.along.sine;
  const double across = std::abs(dy * b.along.cosine - dx * b.along.sine);
  return {std::min(b.half_length - std::abs(along), b.half_width - across),
          (b.ridge - b.pitch * across - p[2]) / std::hypot(1, b.pitch)};
}

double depth_in(const ScanBuilding& b, const Point<3>& p) {
  const Depths depths = depths_in(b, p);
  return std::min(depths.walls, depths.roof);
}

double height_over_ground(const ScanScene& scene, const Point<3>& p) {
  return p[2] - scene.ground.height(p[0], p[1]);
}

bool is_on_ground(const ScanScene& scene, const Point<3>& p) {
  return std::abs(height_over_ground(scene, p)) < kTolerance;
}

double distance(const Point<3>& a, const Point<3>& b) {
  return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
}

/// Whether nothing lies between two places, by steps of 10 centimetres.
bool sees(const ScanScene& scene, const Point<3>& from, const Point<3>& to) {
  const int steps = static_cast<int>(distance(from, to) / 0.1) + 1;
  for (int i = 0; i < steps; ++i) {
    Point<3> p;
    for (int k = 0; k < 3; ++k) p[k] = from[k] + (to[k] - from[k]) * i / steps;
    if (height_over_ground(scene, p) < -kTolerance) return false;
    for (const ScanBuilding& b : scene.buildings) {
      if (std::hypot(p[0] - b.x, p[1] - b.y) < 12 && depth_in(b, p) > kTolerance) return false;
    }
  }
  return true;
}

double azimuth_in_turns(const Point<3>& from, const Point<3>& to) {
  const double turns = std::atan2(to[1] - from[1], to[0] - from[0]) / (2 * std::numbers::pi);
  return turns < 0 ? turns + 1 : turns;
}

/// The points of a turn, which goes on as long as the azimuth grows.
struct Turn {
  Point<3> station;
  std::vector<Point<3>> points;
  double last_azimuth = 0;
};

std::vector<Turn> turns_of(const ScanScene& scene, const std::vector<Point<3>>& points) {
  std::vector<Turn> turns{{scene.stations[0], {}}};
  for (const Point<3>& p : points) {
    double azimuth = azimuth_in_turns(turns.back().station, p);
    if (azimuth < turns.back().last_azimuth - 1e-4) {  // what rounding may change close by
      turns.push_back({scene.stations[turns.size() % scene.stations.size()], {}});
      azimuth = azimuth_in_turns(turns.back().station, p);
    }
    turns.back().points.push_back(p);
    turns.back().last_azimuth = azimuth;
  }
  return turns;
}

TEST(Scan, IsInTenthsOfMillimetres) {
  const auto generator = make_generator({Family::kScan, 10, 3, 1});
  ASSERT_NE(generator->lattice(), nullptr);
  EXPECT_EQ(*generator->lattice(), (IntegerLattice{{0.0001, 0.0001, 0.0001}, {0, 0, 0}}));
}

TEST(Scan, IsTheSameForEitherDimension) {
  const auto flat = generated_points<2>({Family::kScan, 1000, 2, 7});
  const auto full = generated_points<3>({Family::kScan, 1000, 3, 7});
  for (std::size_t i = 0; i < flat.size(); ++i) {
    EXPECT_EQ(flat[i], (Point<2>{full[i][0], full[i][1]}));
  }
}

TEST(Scan, HasPointsOnGroundWallsAndRoofsAndNowhereElse) {
  for (const std::uint64_t seed : {1, 2, 3}) {
    const ScanScene scene(seed);
    std::size_t ground = 0;
    std::size_t walls = 0;
    std::size_t roofs = 0;
    for (const Point<3>& p : scan(20'000, seed)) {
      if (is_on_ground(scene, p)) {
        ++ground;
        continue;
      }
      EXPECT_GT(height_over_ground(scene, p), 0);
      const auto at = std::max_element(
          scene.buildings.begin(), scene.buildings.end(),
          [&](const auto& a, const auto& b) { return depth_in(a, p) < depth_in(b, p); });
      EXPECT_LT(std::abs(depth_in(*at, p)), kTolerance) << p[0] << ' ' << p[1] << ' ' << p[2];
      const Depths depths = depths_in(*at, p);
      ++(depths.walls < depths.roof ? walls : roofs);
    }
    EXPECT_GT(ground, 4'000U);
    EXPECT_GT(walls, 2'000U);
    EXPECT_GT(roofs, 50U);
  }
}

TEST(Scan, HasTwoToFourMillimetresOfNoise) {
  // A wall that faces the station shows them as they are, others show less.
  const ScanScene scene(1);
  std::vector<double> depths;
  for (const Turn& turn : turns_of(scene, scan(50'000, 1))) {
    for (const Point<3>& p : turn.points) {
      for (const ScanBuilding& b : scene.buildings) {
        const Depths at = depths_in(b, p);
        if (std::abs(at.walls) > kTolerance || at.roof < 0.5 || is_on_ground(scene, p)) continue;
        const Point<3> closer = {p[0] + 0.01 * (turn.station[0] - p[0]),
                                 p[1] + 0.01 * (turn.station[1] - p[1]), p[2]};
        const double slant =
            (at.walls - depths_in(b, closer).walls) / (0.01 * distance(turn.station, p));
        if (slant > 0.7) depths.push_back(at.walls / slant);
      }
    }
  }
  ASSERT_GT(depths.size(), 1'000U);
  double sum = 0;
  double squares = 0;
  for (const double depth : depths) {
    sum += depth;
    squares += depth * depth;
  }
  const auto n = static_cast<double>(depths.size());
  EXPECT_NEAR(sum / n, 0, 0.0002);
  EXPECT_GT(std::sqrt(squares / n), 0.002);
  EXPECT_LT(std::sqrt(squares / n), 0.004);
}

TEST(Scan, ShowsNothingBehindWhatItsStationSeesNorBeyondTheRange) {
  for (const std::uint64_t seed : {1, 2}) {
    const ScanScene scene(seed);
    for (const Turn& turn : turns_of(scene, scan(5'000, seed))) {
      for (const Point<3>& p : turn.points) {
        EXPECT_LT(distance(turn.station, p), kScanRange + kTolerance);
        EXPECT_TRUE(sees(scene, turn.station, p)) << p[0] << ' ' << p[1] << ' ' << p[2];
      }
    }
  }
}

TEST(Scan, LeavesGroundInTheShadowOfHousesWithoutPoints) {
  const ScanScene scene(1);
  std::set<std::pair<int, int>> scanned;
  for (const Point<3>& p : scan(200'000, 1)) {
    if (is_on_ground(scene, p)) scanned.emplace(static_cast<int>(p[0]), static_cast<int>(p[1]));
  }
  int hidden = 0;
  for (int x = 100; x < 270; x += 3) {
    for (int y = 100; y < 230; y += 3) {
      const Point<3> p = {x + 0.5, y + 0.5, scene.ground.height(x + 0.5, y + 0.5) + 0.05};
      const bool is_seen =
          std::any_of(scene.stations.begin(), scene.stations.end(), [&](const Point<3>& station) {
            return distance(station, p) < kScanRange && sees(scene, station, p);
          });
      const auto depth = [&](const ScanBuilding& b) { return depths_in(b, p).walls; };
      const bool is_well_hidden =
          !is_seen && std::none_of(scene.buildings.begin(), scene.buildings.end(),
                                   [&](const ScanBuilding& b) { return depth(b) > -2; });
      hidden += is_well_hidden && !scanned.contains({x, y}) ? 1 : 0;
    }
  }
  EXPECT_GT(hidden, 50);
}

TEST(Scan, ComesStationByStationInTheOrderOfAzimuths) {
  for (const std::uint64_t seed : {1, 2, 3, 4, 5}) {
    const ScanScene scene(seed);
    const auto turns = turns_of(scene, scan(100'000, seed));
    ASSERT_EQ(turns.size(), scene.stations.size()) << seed;
    for (const Turn& turn : turns) {
      EXPECT_GT(turn.points.size(), 100'000 / scene.stations.size() / 4);
      EXPECT_GT(turn.last_azimuth, 0.9) << "of the last turn hardly anything is left out";
    }
  }
}

TEST(Scan, IsDenserCloseToTheStation) {
  for (const std::uint64_t seed : {1, 2, 3}) {
    const ScanScene scene(seed);
    const Turn turn = turns_of(scene, scan(200'000, seed)).front();
    const auto in_ring = [&](double from, double to) {
      const auto count =
          std::count_if(turn.points.begin(), turn.points.end(), [&](const Point<3>& p) {
            const double away = std::hypot(p[0] - turn.station[0], p[1] - turn.station[1]);
            return away > from && away < to && is_on_ground(scene, p);
          });
      return static_cast<double>(count);
    };
    const auto rays_to_level_ground = [](double from, double to) {
      return std::atan(1.7 / from) - std::atan(1.7 / to);
    };
    const double expected = rays_to_level_ground(2, 2.5) / rays_to_level_ground(4, 5);
    EXPECT_NEAR(in_ring(2, 2.5) / in_ring(4, 5), expected, 0.1 * expected);
    // A ring that is twice as wide has four times the area and half the points: a square metre has
    // an eighth of them, further away even less in shadows.
    EXPECT_GT(in_ring(4, 5) / in_ring(16, 20), 3);
  }
}

TEST(Scan, GivesPointsAlsoWhereAStationSendsThreeRays) {
  for (std::uint64_t seed = 1; seed <= 30; ++seed) {
    for (const std::uint64_t count : {1, 2, 3, 10}) {
      const auto points = scan(count, seed);
      EXPECT_EQ(std::set(points.begin(), points.end()).size(), count);
    }
  }
}

TEST(Scan, GoesOnWithNewPointsWhereItsSampleHasPromisedTooMuch) {
  int second_turns = 0;
  for (std::uint64_t seed = 1; seed <= 30; ++seed) {
    const ScanScene scene(seed);
    const auto points = scan(100, seed);
    second_turns += turns_of(scene, points).size() > scene.stations.size() ? 1 : 0;
    EXPECT_EQ(std::set(points.begin(), points.end()).size(), 100U);
  }
  EXPECT_GT(second_turns, 0);
}

TEST(ScanScene, HasStreetsThatAreWideEnoughAndEveryNumberOfHousesAndStations) {
  std::set<std::size_t> houses;
  std::set<std::size_t> stations;
  std::set<bool> flat;
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    const ScanScene scene(seed);
    houses.insert(scene.buildings.size());
    stations.insert(scene.stations.size());
    for (const ScanBuilding& b : scene.buildings) {
      flat.insert(b.pitch == 0);
      const double reach = std::hypot(b.half_length, b.half_width);
      for (const ScanBuilding& other : scene.buildings) {
        if (&other == &b) continue;
        EXPECT_GT(std::max(std::abs(b.x - other.x), std::abs(b.y - other.y)),
                  reach + std::hypot(other.half_length, other.half_width) + 4);
      }
      for (const Point<3>& station : scene.stations) {
        EXPECT_GT(std::hypot(b.x - station[0], b.y - station[1]), reach + 6);
      }
    }
    for (const Point<3>& station : scene.stations) {
      EXPECT_NEAR(height_over_ground(scene, station), 1.7, 1e-9);
    }
  }
  EXPECT_EQ(*houses.begin(), 10U);
  EXPECT_EQ(*houses.rbegin(), 20U);
  EXPECT_EQ(stations, (std::set<std::size_t>{3, 4, 5, 6}));
  EXPECT_EQ(flat.size(), 2U);
}

}  // namespace
}  // namespace spillway::test
