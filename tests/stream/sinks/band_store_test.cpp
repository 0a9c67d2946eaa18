// Bands of height: each is as large as the triangles tell, and neighbours have their boundary in
// common.

#include "stream/sinks/band_store.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <memory>
#include <random>
#include <set>
#include <utility>
#include <vector>

#include "stream/sinks/contour_writer.h"

namespace spillway::test {
namespace {

using Triangle = std::array<std::uint32_t, 3>;
using Bands = std::map<std::int64_t, std::vector<PolygonWithHoles>>;

struct Terrain {
  std::vector<LatticePoint> vertices;
  std::vector<Triangle> triangles;
};

/// A grid with holes, of shaken points. Heights are multiples of `step`; 0: any.
Terrain terrain_of(unsigned seed, double noise, double step) {
  constexpr std::uint32_t kSide = 30;
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> shake(-1, 1);
  Terrain terrain;
  for (std::uint32_t y = 0; y <= kSide; ++y) {
    for (std::uint32_t x = 0; x <= kSide; ++x) {
      double z = 6 * std::sin(x / 5.0) * std::cos(y / 6.0) + noise * shake(random);
      if (step > 0) z = step * std::round(z / step);
      // Of two decimals, as surveys have.
      const auto shaken = [&](double where) {
        return std::round(100 * (where + 0.2 * shake(random))) / 100;
      };
      terrain.vertices.push_back({shaken(x), shaken(y), z});
    }
  }
  for (std::uint32_t y = 0; y < kSide; ++y) {
    for (std::uint32_t x = 0; x < kSide; ++x) {
      const std::uint32_t v = y * (kSide + 1) + x;
      if (random() % 6 != 0) terrain.triangles.push_back({v, v + 1, v + kSide + 2});
      if (random() % 6 != 0) terrain.triangles.push_back({v, v + kSide + 2, v + kSide + 1});
    }
  }
  return terrain;
}

/// In blocks of so many triangles, in an order given by a seed.
Bands bands_of(const Terrain& terrain, const Levels& levels, const LineTolerance& tolerance = {},
               std::size_t block_size = 1 << 20, unsigned seed = 0) {
  const auto scratch = make_scratch_folder(::testing::TempDir(), std::nullopt);
  BandStore store(levels, *scratch);
  ContourWriter writer(
      {.levels = levels, .tolerance = tolerance, .finds_hull = true, .memory = 1 << 20},
      [&](std::span<const Point<2>> points, std::int64_t level) { store.add_line(points, level); },
      *scratch, [&](const HullEdge& edge) { store.add_hull_edge(edge); });
  MeshStreamBlock all;
  all.vertices = terrain.vertices;
  writer.write(std::move(all));
  std::vector<Triangle> triangles = terrain.triangles;
  std::shuffle(triangles.begin(), triangles.end(), std::mt19937(seed));
  std::map<std::uint32_t, std::size_t> uses;
  for (const Triangle& triangle : triangles) {
    for (const std::uint32_t v : triangle) ++uses[v];
  }
  for (std::size_t begin = 0; begin < triangles.size(); begin += block_size) {
    MeshStreamBlock block;
    std::map<std::uint32_t, std::uint32_t> names;
    for (std::size_t t = begin; t < std::min(triangles.size(), begin + block_size); ++t) {
      for (const std::uint32_t v : triangles[t]) {
        const auto [name, is_new] =
            names.emplace(v, static_cast<std::uint32_t>(block.imported.size()));
        if (is_new) block.imported.push_back(v);
        block.corners.push_back(name->second);
        if (--uses[v] == 0) block.finalized.push_back(name->second);
      }
    }
    writer.write(std::move(block));
  }
  writer.finish({});
  Bands bands;
  store.finish(
      [&](const PolygonWithHoles& polygon, std::int64_t band) { bands[band].push_back(polygon); });
  return bands;
}

double area(const Ring& ring) {
  double twice = 0;
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const Point<2>& a = ring[i];
    const Point<2>& b = ring[(i + 1) % ring.size()];
    twice += a[0] * b[1] - b[0] * a[1];
  }
  return twice / 2;
}

double area(const std::vector<PolygonWithHoles>& polygons) {
  double sum = 0;
  for (const PolygonWithHoles& polygon : polygons) {
    EXPECT_GT(area(polygon.outer), 0);
    sum += area(polygon.outer);
    for (const Ring& hole : polygon.holes) {
      EXPECT_LT(area(hole), 0);
      sum += area(hole);
    }
  }
  return sum;
}

/// The part of a triangle that is below a height, by how much larger the whole one is at its lowest
/// or its highest corner.
double area_below(std::array<Point<3>, 3> corners, double height) {
  const double whole = std::abs((corners[1][0] - corners[0][0]) * (corners[2][1] - corners[0][1]) -
                                (corners[1][1] - corners[0][1]) * (corners[2][0] - corners[0][0])) /
                       2;
  std::ranges::sort(corners, {}, [](const Point<3>& p) { return p[2]; });
  const auto [low, middle, high] = std::array{corners[0][2], corners[1][2], corners[2][2]};
  if (height <= low) return 0;
  if (height >= high) return whole;
  if (height <= middle) {
    return whole * (height - low) * (height - low) / ((middle - low) * (high - low));
  }
  return whole * (1 - (high - height) * (high - height) / ((high - middle) * (high - low)));
}

double area_of_triangles(const Terrain& terrain, double low, double high) {
  double sum = 0;
  for (const Triangle& t : terrain.triangles) {
    const std::array corners = {Point<3>(terrain.vertices[t[0]]), Point<3>(terrain.vertices[t[1]]),
                                Point<3>(terrain.vertices[t[2]])};
    sum += area_below(corners, high) - area_below(corners, low);
  }
  return sum;
}

/// Edges of all rings, forth as 1 and back as -1.
std::map<std::pair<Point<2>, Point<2>>, int> edges_of(const Bands& bands) {
  std::map<std::pair<Point<2>, Point<2>>, int> edges;
  const auto add = [&](const Ring& ring) {
    for (std::size_t i = 0; i < ring.size(); ++i) {
      const Point<2>& a = ring[i];
      const Point<2>& b = ring[(i + 1) % ring.size()];
      edges[std::minmax(a, b)] += a < b ? 1 : -1;
    }
  };
  for (const auto& [band, polygons] : bands) {
    for (const PolygonWithHoles& polygon : polygons) {
      add(polygon.outer);
      std::ranges::for_each(polygon.holes, add);
    }
  }
  return edges;
}

void expect_right(const Terrain& terrain, const Levels& levels, const Bands& bands, bool is_exact) {
  const double whole = area_of_triangles(terrain, -1e9, 1e9);
  double sum = 0;
  for (const auto& [band, polygons] : bands) {
    const double found = area(polygons);
    sum += found;
    if (!is_exact) continue;
    const double low = levels.has(band) ? levels.height(band) : -1e9;
    const double high = levels.has(band + 1) ? levels.height(band + 1) : 1e9;
    EXPECT_NEAR(found, area_of_triangles(terrain, low, high), 1e-9 * whole) << band;
  }
  EXPECT_NEAR(sum, whole, 1e-9 * whole);
  // What does not run to and fro is the hull: as long as that of the triangles.
  Bands hull;
  for (const Triangle& t : terrain.triangles) {
    const auto at = [&](int i) {
      return Point<2>{terrain.vertices[t[i]][0], terrain.vertices[t[i]][1]};
    };
    hull[0].push_back({.outer = {at(0), at(1), at(2)}, .holes = {}});
  }
  const auto length = [](const Bands& some) {
    double open = 0;
    for (const auto& [edge, times] : edges_of(some)) {
      EXPECT_LE(std::abs(times), 1);
      if (times != 0) {
        open += std::hypot(edge.second[0] - edge.first[0], edge.second[1] - edge.first[1]);
      }
    }
    return open;
  };
  EXPECT_NEAR(length(bands), length(hull), 1e-9 * length(hull));
}

void expect_simple_rings(const Bands& bands) {
  for (const auto& [band, polygons] : bands) {
    for (const PolygonWithHoles& polygon : polygons) {
      std::vector<Ring> rings = polygon.holes;
      rings.push_back(polygon.outer);
      for (const Ring& ring : rings) {
        EXPECT_EQ(std::set(ring.begin(), ring.end()).size(), ring.size());
        EXPECT_EQ(*std::ranges::min_element(ring), ring.front());
      }
    }
  }
}

const std::vector<Levels> kLevels = {Levels::every(1, 0.125), Levels::every(0.3, 0),
                                     Levels::every(1, 0), Levels::every(100, -50),
                                     Levels::of_list({-3, -2.75, 0.5, 2, 99})};

TEST(Bands, AreAsLargeAsTrianglesTellAndHaveBoundariesInCommon) {
  for (unsigned seed = 0; seed < 3; ++seed) {
    for (const double step : {0.0, 0.5, 1.0}) {
      const Terrain terrain = terrain_of(seed, seed, step);
      for (const Levels& levels : kLevels) {
        const Bands bands = bands_of(terrain, levels);
        expect_right(terrain, levels, bands, true);
        expect_simple_rings(bands);
      }
    }
  }
}

TEST(Bands, OfSmoothAndSimpleLinesStillCoverAll) {
  for (unsigned seed = 0; seed < 3; ++seed) {
    for (const double step : {0.0, 1.0}) {
      const Terrain terrain = terrain_of(seed, seed, step);
      for (const Levels& levels : kLevels) {
        const Bands bands = bands_of(terrain, levels, {.smooth = 0.5, .simplify = 0.3});
        expect_right(terrain, levels, bands, false);
        expect_simple_rings(bands);
      }
    }
  }
}

TEST(Bands, DoNotDependOnTheOrderOfTrianglesOrBlocks) {
  const Terrain terrain = terrain_of(1, 1, 0.5);
  for (const LineTolerance& tolerance : {LineTolerance{}, LineTolerance{.simplify = 0.3}}) {
    const auto lists = [&](std::size_t block_size, unsigned seed) {
      std::vector<std::pair<std::int64_t, std::vector<Ring>>> list;
      for (const auto& [band, polygons] :
           bands_of(terrain, kLevels[1], tolerance, block_size, seed)) {
        for (const PolygonWithHoles& polygon : polygons) {
          list.emplace_back(band, polygon.holes);
          list.back().second.push_back(polygon.outer);
        }
      }
      return list;
    };
    const auto expected = lists(1 << 20, 0);
    EXPECT_GT(expected.size(), 100U);
    for (const std::size_t block_size : {1U, 7U, 300U}) {
      EXPECT_EQ(lists(block_size, static_cast<unsigned>(block_size)), expected) << block_size;
    }
  }
}

}  // namespace
}  // namespace spillway::test
