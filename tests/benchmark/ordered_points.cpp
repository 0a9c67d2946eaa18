// ordered_points FAMILY: the same points in an order of choice, as spp. What triangulates a pipe
// meets orders that no generator has. Points are made and ordered in memory (12 bytes each) before
// the output is opened, so a reader of a named pipe does not wait for that. The same arguments give
// the same bytes on every machine.

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <map>
#include <span>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "formats/disk/file_system.h"
#include "formats/points/create_points.h"
#include "src/error.h"
#include "src/generators/generators.h"
#include "src/generators/random.h"

namespace spillway::test {
namespace {

constexpr std::size_t kBlockPoints = 65536;

/// What --order takes.
enum class Order {
  kScan,      ///< as the generator gives them: flight lines
  kRandom,    ///< shuffled
  kCurve,     ///< along a Hilbert curve
  kOutwards,  ///< by the distance from the centre
  kStrips,    ///< in several passes over the whole area, each in strips of its own direction
};

struct Plan {
  std::string family = "terrain";
  double count = 1'000'000;  // so that 150e6 can be said
  std::uint64_t seed = 1;
  Order order = Order::kScan;
  bool told = false;
  std::string output = "-";
};

/// Integers of the family's lattice. Points of equal coordinates are the same, so an order that
/// says nothing about them is still one order only.
using Place = std::array<std::int32_t, 3>;

struct PlaceBox {
  Place lo, hi;
};

struct Places {
  std::vector<Place> points;
  IntegerLattice lattice;
  int coordinates = 3;
};

std::int32_t to_int32(double coordinate) {
  if (coordinate < std::numeric_limits<std::int32_t>::min() ||
      coordinate > std::numeric_limits<std::int32_t>::max()) {
    throw InvalidArgument("coordinates leave the 32-bit integers: ask for fewer points");
  }
  return static_cast<std::int32_t>(coordinate);
}

Places make_places(const Plan& plan) {
  const Family family = family_by_name(plan.family);
  const auto count = static_cast<std::uint64_t>(plan.count);
  const auto generator =
      make_generator({.family = family, .count = count, .dimension = 2, .seed = plan.seed});
  if (generator->lattice() == nullptr) {
    throw InvalidArgument(
        fmt::format("points of {} are no integers: choose a family on a lattice", plan.family));
  }
  Places places{{}, *generator->lattice(), family == Family::kTerrain ? 3 : 2};
  places.points.reserve(count);
  std::vector<Point<3>> block(kBlockPoints);
  while (const std::size_t size = generator->next(block)) {
    for (const Point<3>& p : std::span(block).first(size)) {
      places.points.push_back({to_int32(p[0]), to_int32(p[1]), to_int32(p[2])});
    }
  }
  return places;
}

PlaceBox box_of(std::span<const Place> points) {
  PlaceBox box{points[0], points[0]};
  for (const Place& p : points) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      box.lo[axis] = std::min(box.lo[axis], p[axis]);
      box.hi[axis] = std::max(box.hi[axis], p[axis]);
    }
  }
  return box;
}

/// Fisher and Yates. The standard's shuffle is not the same everywhere.
void shuffle(std::span<Place> points, std::uint64_t seed) {
  Random random(mix_bits(seed) + 1);
  for (std::size_t left = points.size(); left > 1; --left) {
    std::swap(points[left - 1], points[random.below(left)]);
  }
}

/// A square that a Hilbert curve fills. It enters in one corner and leaves in the next along the
/// other axis than `axis`, along which its first half and its second half lie side by side.
struct CurveSquare {
  std::array<std::int64_t, 2> lo;
  std::int64_t side;  ///< a power of two
  std::size_t axis;
  std::array<bool, 2> ascending;  ///< whether the curve enters at the low end of each axis
};

/// Moves the points of a square's lower half along an axis, or of its upper one, to the front.
std::span<Place>::iterator halve(std::span<Place> points, const CurveSquare& square,
                                 std::size_t axis, bool lower_first) {
  const std::int64_t middle = square.lo[axis] + square.side / 2;
  return std::partition(points.begin(), points.end(),
                        [=](const Place& p) { return (p[axis] < middle) == lower_first; });
}

void sort_along_curve(std::span<Place> points, const CurveSquare& square) {
  if (points.size() < 2) return;
  if (square.side == 1) {
    std::sort(points.begin(), points.end());
    return;
  }
  const std::size_t a = square.axis;
  const std::size_t b = 1 - a;
  const std::int64_t half = square.side / 2;
  const bool up_a = square.ascending[a];
  const bool up_b = square.ascending[b];
  const auto quarter = [&](bool second_a, bool second_b, std::size_t axis, bool turned_round) {
    CurveSquare part{square.lo, half, axis, square.ascending};
    if (second_a == up_a) part.lo[a] += half;
    if (second_b == up_b) part.lo[b] += half;
    if (turned_round) part.ascending = {!part.ascending[0], !part.ascending[1]};
    return part;
  };
  const auto middle = halve(points, square, a, up_a);
  const auto first = halve({points.begin(), middle}, square, b, up_b);
  const auto last = halve({middle, points.end()}, square, b, !up_b);
  sort_along_curve({points.begin(), first}, quarter(false, false, b, false));
  sort_along_curve({first, middle}, quarter(false, true, a, false));
  sort_along_curve({middle, last}, quarter(true, true, a, false));
  sort_along_curve({last, points.end()}, quarter(true, false, b, true));
}

void sort_along_curve(std::span<Place> points) {
  const PlaceBox box = box_of(points);
  CurveSquare square{{box.lo[0], box.lo[1]}, 1, 0, {true, true}};
  while (box.hi[0] - square.lo[0] >= square.side || box.hi[1] - square.lo[1] >= square.side) {
    square.side *= 2;
  }
  sort_along_curve(points, square);
}

void sort_outwards(std::span<Place> points) {
  const PlaceBox box = box_of(points);
  const std::int64_t x = (std::int64_t{box.lo[0]} + box.hi[0]) / 2;
  const std::int64_t y = (std::int64_t{box.lo[1]} + box.hi[1]) / 2;
  const auto distance = [=](const Place& p) {
    return static_cast<std::uint64_t>((p[0] - x) * (p[0] - x)) +
           static_cast<std::uint64_t>((p[1] - y) * (p[1] - y));
  };
  std::sort(points.begin(), points.end(), [&](const Place& p, const Place& q) {
    return std::pair(distance(p), p) < std::pair(distance(q), q);
  });
}

/// A direction of flight, and how wide its strips are: 2^log2_width, in the unit of the direction's
/// length, which is 150 to 230 metres of a terrain.
struct Pass {
  std::int64_t x, y;
  int log2_width;
};

constexpr std::array<Pass, 8> kPasses = {{{1, 0, 14},
                                          {0, 1, 14},
                                          {1, 1, 15},
                                          {-1, 1, 15},
                                          {2, 1, 15},
                                          {-1, 2, 15},
                                          {1, 2, 15},
                                          {-2, 1, 15}}};

/// Each pass gets its share of the points at random. It flies its strips back and forth.
void sort_into_strips(std::span<Place> points, std::uint64_t seed) {
  shuffle(points, seed);
  for (std::size_t i = 0; i < kPasses.size(); ++i) {
    const Pass pass = kPasses[i];
    const auto place_of_flight = [=](const Place& p) {
      const std::int64_t strip = (pass.x * p[1] - pass.y * p[0]) >> pass.log2_width;
      const std::int64_t along = pass.x * p[0] + pass.y * p[1];
      return std::tuple(strip, strip % 2 == 0 ? along : -along, p);
    };
    const auto begin =
        points.begin() + static_cast<std::ptrdiff_t>(points.size() * i / kPasses.size());
    const auto end =
        points.begin() + static_cast<std::ptrdiff_t>(points.size() * (i + 1) / kPasses.size());
    std::sort(begin, end, [&](const Place& p, const Place& q) {
      return place_of_flight(p) < place_of_flight(q);
    });
  }
}

void put_in_order(std::span<Place> points, const Plan& plan) {
  switch (plan.order) {
    case Order::kScan:
      return;
    case Order::kRandom:
      return shuffle(points, plan.seed);
    case Order::kCurve:
      return sort_along_curve(points);
    case Order::kOutwards:
      return sort_outwards(points);
    case Order::kStrips:
      return sort_into_strips(points, plan.seed);
  }
}

LatticePoint to_lattice(const Place& p) {
  return {static_cast<double>(p[0]), static_cast<double>(p[1]), static_cast<double>(p[2])};
}

void write(const Places& places, const Plan& plan) {
  PointWriterOptions options{
      .format = "spp", .coordinates = places.coordinates, .lattice = places.lattice};
  if (plan.told) {
    const PlaceBox box = box_of(places.points);
    options.count = places.points.size();
    options.extent.emplace();
    options.extent->expand(places.lattice.to_world(to_lattice(box.lo)));
    options.extent->expand(places.lattice.to_world(to_lattice(box.hi)));
  }
  const auto writer = open_point_writer(disk(), plan.output, options);
  std::vector<LatticePoint> block;
  std::span<const Place> left(places.points);
  while (!left.empty()) {
    const auto next = left.first(std::min(left.size(), kBlockPoints));
    block.clear();
    for (const Place& p : next) block.push_back(to_lattice(p));
    writer->write(block, {});
    left = left.subspan(next.size());
  }
  writer->finish();
}

void run(const Plan& plan) {
  Places places = make_places(plan);
  put_in_order(places.points, plan);
  write(places, plan);
}

}  // namespace
}  // namespace spillway::test

int main(int argc, char** argv) {
  using spillway::test::Order;
  spillway::test::Plan plan;
  CLI::App app("Writes the same points in an order of choice, as spp");
  app.add_option("family", plan.family, "terrain, or another family of integers");
  app.add_option("-n,--points", plan.count, "How many, as 150e6")
      ->check(CLI::Range(1.0, 4294967295.0));
  app.add_option("--seed", plan.seed, "Of the points and of their order");
  const std::map<std::string, Order> orders{{"scan", Order::kScan},
                                            {"random", Order::kRandom},
                                            {"curve", Order::kCurve},
                                            {"outwards", Order::kOutwards},
                                            {"strips", Order::kStrips}};
  app.add_option("--order", plan.order, "scan, random, curve, outwards or strips")
      ->transform(CLI::CheckedTransformer(orders));
  app.add_flag("--told", plan.told, "The header tells the number of points and their extent");
  app.add_option("-o,--output", plan.output, "A file or a named pipe; -: standard output");
  CLI11_PARSE(app, argc, argv);
  try {
    spillway::test::run(plan);
  } catch (const spillway::runtime::Failure& error) {
    fmt::print(stderr, "ordered_points: {}\n", error.what());
    return 1;
  }
  return 0;
}
