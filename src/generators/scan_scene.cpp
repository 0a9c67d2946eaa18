#include "src/generators/scan_scene.h"

#include <algorithm>
#include <array>
#include <span>

#include "src/generators/noise.h"
#include "src/generators/random.h"
#include "src/generators/shuffle.h"

namespace spillway::generators {
namespace {

// The streets leave plots that are squares; a station stands where two streets cross.
constexpr std::uint64_t kPlotColumns = 5;
constexpr std::uint64_t kPlotRows = 4;
constexpr std::uint64_t kPlots = kPlotColumns * kPlotRows;
constexpr std::uint64_t kCrossings = (kPlotColumns - 1) * (kPlotRows - 1);
constexpr double kPlot = 36;
constexpr double kMargin = 96;  ///< around the plots; streets that bound them have no stations
constexpr double kMostStray = 3;
constexpr std::size_t kSide = 384;
static_assert(kMargin + kPlot - kMostStray > kScanRange);
static_assert(kMargin + kPlot * (kPlotColumns - 1) + kMostStray + kScanRange < kSide - 1);

constexpr double kEyeHeight = 1.7;
constexpr std::uint64_t kFewestStations = 3;
constexpr std::uint64_t kMostStations = 6;
constexpr std::uint64_t kFewestBuildings = 10;
constexpr double kFlatRoofs = 0.3;

/// The unlike things of a scene have random numbers of their own.
enum Purpose : std::uint64_t { kGroundNoise, kPlotOrder, kCrossingOrder, kNumbers };

std::uint64_t key_of(std::uint64_t seed, Purpose purpose) { return mix_bits(seed) + purpose; }

double between(Random& random, double least, double most) {
  return least + (most - least) * random.uniform();
}

ScanBuilding building_on(std::uint64_t plot, const ScanGround& ground, Random& random) {
  constexpr double kMostOffset = 2;
  constexpr double kMostTurn = 0.04;  // 14 degrees
  const auto middle = [&](std::uint64_t number) {
    return kMargin + kPlot * (static_cast<double>(number) + 0.5) +
           between(random, -kMostOffset, kMostOffset);
  };
  ScanBuilding building{};
  building.x = middle(plot % kPlotColumns);
  building.y = middle(plot / kPlotColumns);
  const double quarter = random.uniform() < 0.5 ? 0 : 0.25;
  building.along = direction_at(quarter + between(random, -kMostTurn, kMostTurn));
  building.half_length = between(random, 5, 10);
  building.half_width = between(random, 4, 6.5);
  const double eaves = ground.height(building.x, building.y) + between(random, 3, 9);
  const double pitch = between(random, 0.35, 1);
  building.pitch = random.uniform() < kFlatRoofs ? 0 : pitch;
  building.ridge = eaves + building.pitch * building.half_width;
  return building;
}

Point<3> station_at(std::uint64_t crossing, const ScanGround& ground, Random& random) {
  const auto place = [&](std::uint64_t number) {
    return kMargin + kPlot * static_cast<double>(number + 1) +
           between(random, -kMostStray, kMostStray);
  };
  const double x = place(crossing % (kPlotColumns - 1));
  const double y = place(crossing / (kPlotColumns - 1));
  return {x, y, ground.height(x, y) + kEyeHeight};
}

}  // namespace

ScanGround::ScanGround(std::uint64_t seed) : heights_(kSide * kSide, 100) {
  // The longer a wave, the higher: 64 metres to 4.
  constexpr int kLongest = 6;
  constexpr int kShortest = 2;
  constexpr float kAmplitude = 4;
  constexpr float kPersistence = 0.4F;
  float amplitude = kAmplitude;
  for (int k = kLongest; k >= kShortest; --k) {
    const Noise octave(seed, k);
    for (std::size_t row = 0; row < kSide; ++row) {
      octave.add_row(0, static_cast<std::int64_t>(row), amplitude,
                     std::span(heights_).subspan(row * kSide, kSide));
    }
    amplitude *= kPersistence;
  }
}

double ScanGround::height(double x, double y) const {
  const auto column = static_cast<std::size_t>(x);
  const auto row = static_cast<std::size_t>(y);
  const double dx = x - static_cast<double>(column);
  const double dy = y - static_cast<double>(row);
  const float* const below = &heights_[row * kSide + column];
  const float* const above = below + kSide;
  const double at_row = below[0] + (below[1] - below[0]) * dx;
  const double at_next = above[0] + (above[1] - above[0]) * dx;
  return at_row + (at_next - at_row) * dy;
}

ScanScene::ScanScene(std::uint64_t seed) : ground(key_of(seed, kGroundNoise)) {
  Random random(key_of(seed, kNumbers));
  const std::uint64_t built = kFewestBuildings + random.below(kPlots - kFewestBuildings + 1);
  const Shuffle plots(key_of(seed, kPlotOrder), kPlots);
  for (std::uint64_t i = 0; i < built; ++i) {
    buildings.push_back(building_on(plots(i), ground, random));
  }
  const std::uint64_t setups = kFewestStations + random.below(kMostStations - kFewestStations + 1);
  const Shuffle crossings(key_of(seed, kCrossingOrder), kCrossings);
  for (std::uint64_t i = 0; i < setups; ++i) {
    stations.push_back(station_at(crossings(i), ground, random));
  }
}

}  // namespace spillway::generators
