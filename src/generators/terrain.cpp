// Airborne LiDAR as it comes from a scanner. An aircraft flies parallel lines back and forth; a
// mirror swings across the track and draws a zig-zag of pulses on the ground. docs/generators.md
// describes the model.

#include <algorithm>
#include <cmath>
#include <optional>

#include <fmt/format.h>

#include "src/error.h"
#include "src/generators/families.h"
#include "src/generators/random.h"
#include "src/generators/relief.h"

namespace spillway::generators {
namespace {

constexpr double kScale = 0.01;  // metres a lattice step
constexpr double kStepsPerMetre = 100;
constexpr double kDensity = 5;         // pulses a square metre under one flight line
constexpr double kLeastSide = 300;     // metres; fewer points are spread over this square
constexpr double kLineDistance = 300;  // metres, about
constexpr double kSwathPerDistance = 4.0 / 3;
constexpr double kPointsPerPulse = 0.92;  // less than it is, so that the planned lines suffice
constexpr double kMargin = 64;            // keeps all coordinates positive
constexpr double kMostJitter = 1;         // metres
constexpr double kMostWander = 3;         // metres that the aircraft strays from its line
constexpr double kFastest = 1.3;          // speed relative to the mean one
constexpr double kLargestSide = 2.1e7;    // metres; 2^31 centimetres are a little more

/// Where the flight lines are and how the pulses are spaced, for a number of points.
struct FlightPlan {
  double side;  ///< metres; the area is a square
  double line_distance;
  double swath;          ///< metres on the ground across the track
  double advance;        ///< mean metres along the track a sweep
  double jitter;         ///< metres either way
  std::uint64_t pulses;  ///< a sweep

  explicit FlightPlan(std::uint64_t count) {
    const double least_pulses = 64;
    const double pulses_per_area =
        std::max(least_pulses, static_cast<double>(count) / kPointsPerPulse) / kSwathPerDistance;
    side = std::max(kLeastSide, std::sqrt(pulses_per_area / kDensity));
    if (side > kLargestSide) {
      throw Failure(
          fmt::format(
              "cannot make a terrain of {} points: its coordinates in centimetres would leave the "
              "32-bit integers of LAS; ask for at most 10^15",
              count),
          ErrorCode::kTooLarge);
    }
    const double density = pulses_per_area / (side * side);
    line_distance = side / std::max(3.0, std::floor(side / kLineDistance + 0.5));
    swath = line_distance * kSwathPerDistance;
    pulses = std::max<std::uint64_t>(2, static_cast<std::uint64_t>(swath * std::sqrt(density)));
    advance = static_cast<double>(pulses) / (density * swath);
    jitter = std::min(kMostJitter, 0.25 / std::sqrt(density));
  }
};

/// Smooth random numbers along the flight, in [-1, 1].
class Drift {
 public:
  Drift(std::uint64_t seed, std::uint64_t period) : seed_(seed), period_(period) {}

  [[nodiscard]] double at(std::uint64_t sweep) const {
    const std::uint64_t knot = sweep / period_;
    const double t = static_cast<double>(sweep % period_) / static_cast<double>(period_);
    const double a = Random(seed_, knot).uniform();
    const double b = Random(seed_, knot + 1).uniform();
    return 2 * (a + (b - a) * (t * t * (3 - 2 * t))) - 1;
  }

 private:
  std::uint64_t seed_, period_;
};

/// Takes a pulse's 64 random bits apart.
class PulseBits {
 public:
  explicit PulseBits(std::uint64_t bits) : bits_(bits) {}

  /// The next n bits.
  std::uint32_t take(int n) {
    const auto value = static_cast<std::uint32_t>(bits_ & ((std::uint64_t{1} << n) - 1));
    bits_ >>= n;
    return value;
  }

  /// The next n bits as a number in [0, 1).
  double fraction(int n) { return take(n) * (1.0 / static_cast<double>(1U << n)); }

 private:
  std::uint64_t bits_;
};

class Terrain final : public PointGenerator {
 public:
  explicit Terrain(const GeneratorOptions& options)
      : remaining_(options.count),
        plan_(options.count),
        relief_(options.seed),
        random_(mix_bits(options.seed) + 1),
        wander_(mix_bits(options.seed) + 2, 600),
        speed_(mix_bits(options.seed) + 3, 250) {
    begin_line();
  }

  std::size_t next(std::span<Point<3>> points) override {
    const std::size_t wanted = std::min<std::uint64_t>(points.size(), remaining_);
    std::size_t n = 0;
    while (n < wanted) {
      if (waiting_) {
        points[n++] = *waiting_;
        waiting_.reset();
      } else if (pulse_ == plan_.pulses) {
        begin_sweep();
      } else {
        n += sweep(points.subspan(n, wanted - n));
      }
    }
    remaining_ -= n;
    return n;
  }

  [[nodiscard]] const IntegerLattice* lattice() const override { return &kLattice; }

 private:
  static constexpr IntegerLattice kLattice{{kScale, kScale, kScale}, {500000, 4100000, 0}};

  void begin_line() {
    line_centre_ = kMargin + plan_.line_distance * (line_ + 0.5);
    heading_ = line_ % 2 == 0 ? 1 : -1;
    along_ = 0;
    const double reach = plan_.swath / 2 + kMostWander + kMostJitter + 1;
    const auto first = static_cast<std::int64_t>(line_centre_ - reach);
    const auto columns = static_cast<std::size_t>(2 * reach) + 3;
    const double rows = kFastest * plan_.advance + 2 * plan_.jitter + 3;
    relief_.set_window(first, columns, static_cast<std::size_t>(rows));
    first_column_ = first;
    ++line_;
    aim_sweep();
  }

  void begin_sweep() {
    along_ += sweep_advance_;
    ++sweep_;
    if (along_ > plan_.side) {
      begin_line();
    } else {
      aim_sweep();
    }
  }

  void aim_sweep() {
    pulse_ = 0;
    sweep_centre_ = line_centre_ + kMostWander * wander_.at(sweep_);
    sweep_advance_ = plan_.advance * (1 + (kFastest - 1) * speed_.at(sweep_));
  }

  /// Sends pulses until the sweep is over, the span is full or a second return waits. Returns the
  /// number of points.
  std::size_t sweep(std::span<Point<3>> points);

  std::uint64_t remaining_;
  FlightPlan plan_;
  Relief relief_;
  Random random_;
  Drift wander_, speed_;

  std::int64_t first_column_ = 0;
  std::uint64_t line_ = 0;
  double line_centre_ = 0;
  double heading_ = 1;  // along y
  double along_ = 0;    // metres of the line flown before this sweep
  std::uint64_t sweep_ = 0;
  double sweep_centre_ = 0;
  double sweep_advance_ = 0;
  std::uint64_t pulse_ = 0;
  std::optional<Point<3>> waiting_;  // the second return of the last pulse
};

std::size_t Terrain::sweep(std::span<Point<3>> points) {
  // Shares of 1024.
  constexpr std::uint32_t kWaterReturns = 30;
  constexpr std::uint32_t kThroughCrown = 350;
  constexpr std::uint32_t kCrownAndGround = 40;
  constexpr std::uint32_t kRepeats = 13;

  const double flown = heading_ > 0 ? kMargin + along_ : kMargin + plan_.side - along_;
  const double half_swath = (sweep_ % 2 == 0 ? 0.5 : -0.5) * plan_.swath;
  const double time_step = 2.0 / static_cast<double>(plan_.pulses);
  const double y_step = heading_ * sweep_advance_ / static_cast<double>(plan_.pulses);
  Random random = random_;
  std::uint64_t pulse = pulse_;
  std::size_t n = 0;
  while (n < points.size() && pulse < plan_.pulses && !waiting_) {
    PulseBits bits(random.bits());
    const auto sent = static_cast<double>(pulse++);
    // The mirror slows down before it turns: pulses lie denser at the edges of the swath.
    const double t = time_step * (sent + 0.5) - 1;
    const double x = sweep_centre_ + half_swath * (t * (1.25 - 0.25 * t * t)) +
                     plan_.jitter * (2 * bits.fraction(11) - 1);
    const double y = flown + y_step * sent + plan_.jitter * (2 * bits.fraction(11) - 1);
    const auto column = static_cast<std::int64_t>(x);
    const auto row = static_cast<std::int64_t>(y);
    const double dx = x - static_cast<double>(column);
    const double dy = y - static_cast<double>(row);
    const ReliefCell* below = relief_.row(row) + (column - first_column_);
    const ReliefCell* above = relief_.row(row + 1) + (column - first_column_);

    const std::uint32_t chance = bits.take(10);
    if (below->cover == Cover::kWater && chance >= kWaterReturns) continue;
    const double noise = 0.06 * (bits.fraction(6) - 0.5);
    const double depth = bits.fraction(10);
    const std::uint32_t repeat = bits.take(10);
    const std::uint32_t difference = bits.take(4);

    const double ground_below = below[0].ground + (below[1].ground - below[0].ground) * dx;
    const double ground_above = above[0].ground + (above[1].ground - above[0].ground) * dx;
    const double ground = ground_below + (ground_above - ground_below) * dy + noise;
    double z = ground;
    std::optional<double> second;
    if (below->cover == Cover::kRoof) {
      z = below->top + below->slope_x * (dx - 0.5) + below->slope_y * (dy - 0.5) + noise;
    } else if (below->cover == Cover::kCrown && chance >= kThroughCrown) {
      z = ground + below->top * (1 - 0.35 * depth * depth);
      if (chance < kThroughCrown + kCrownAndGround) second = ground;
    }
    // A few records are there twice, half of them with the same elevation.
    if (repeat < kRepeats) second = difference < 8 ? z : z + kScale * difference;

    // All coordinates are positive, so that this rounds down.
    const auto on_lattice = [](double metres) {
      return static_cast<double>(static_cast<std::int64_t>(metres * kStepsPerMetre));
    };
    const Point<3> p = {on_lattice(x), on_lattice(y), on_lattice(z)};
    points[n++] = p;
    if (second) waiting_ = Point<3>{p[0], p[1], on_lattice(*second)};
  }
  random_ = random;
  pulse_ = pulse;
  return n;
}

}  // namespace

std::unique_ptr<PointGenerator> make_terrain(const GeneratorOptions& options) {
  return std::make_unique<Terrain>(options);
}

}  // namespace spillway::generators
