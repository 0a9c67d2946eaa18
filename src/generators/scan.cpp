// A few houses as a terrestrial laser scanner sees them from several stations. Described in
// docs/generators.md.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>

#include "src/generators/families.h"
#include "src/generators/random.h"
#include "src/generators/scan_column.h"
#include "src/generators/scan_scene.h"

namespace spillway::generators {
namespace {

constexpr double kScale = 0.0001;  // metres a lattice step
constexpr double kStepsPerMetre = 10000;

// A column has rays from 60 degrees below the horizon to 60 above it.
constexpr double kLowest = -1.0 / 6;  // turns
constexpr double kSwing = 1.0 / 3;    // turns

constexpr double kLeastNoise = 0.002;  // metres; standard deviation close to the scanner,
constexpr double kMoreNoise = 0.002;   // and how much it grows up to the end of the range

/// Evenly spaced rays: as many degrees from row to row as from column to column. The lowest of
/// three rows already points 40 degrees down, so every column has a point on the ground, or on what
/// stands there.
struct Raster {
  std::uint64_t rows, columns;

  /// Of at least so many rays.
  explicit Raster(double rays)
      : rows(std::max<std::uint64_t>(3, static_cast<std::uint64_t>(std::sqrt(rays * kSwing)))),
        columns(std::max<std::uint64_t>(
            1, static_cast<std::uint64_t>(std::ceil(rays / static_cast<double>(rows))))) {}

  [[nodiscard]] Direction elevation(std::uint64_t row) const {
    return direction_at(kLowest +
                        kSwing * ((static_cast<double>(row) + 0.5) / static_cast<double>(rows)));
  }

  [[nodiscard]] Direction azimuth(std::uint64_t column, double start) const {
    return direction_at((static_cast<double>(column) + start) / static_cast<double>(columns));
  }
};

/// The share of all rays of all stations that hit something, by a sample.
double share_of_hits(const ScanScene& scene) {
  const Raster raster(10'000);
  ScanColumn view(scene);
  std::uint64_t hits = 0;
  for (const Point<3>& station : scene.stations) {
    for (std::uint64_t column = 0; column < raster.columns; ++column) {
      view.aim(station, raster.azimuth(column, 0.5));
      for (std::uint64_t row = 0; row < raster.rows && !view.is_done(); ++row) {
        hits += view.first_hit(raster.elevation(row)) ? 1 : 0;
      }
    }
  }
  return static_cast<double>(hits) /
         static_cast<double>(scene.stations.size() * raster.columns * raster.rows);
}

/// Normal numbers in pairs.
class Normals {
 public:
  explicit Normals(std::uint64_t seed) : random_(seed) {}

  double next() {
    if (!has_second_) pair_ = random_.normal_pair();
    has_second_ = !has_second_;
    return pair_[has_second_ ? 0 : 1];
  }

 private:
  Random random_;
  std::array<double, 2> pair_{};
  bool has_second_ = false;
};

class Scan final : public PointGenerator {
 public:
  explicit Scan(const GeneratorOptions& options)
      : remaining_(options.count),
        scene_(options.seed),
        raster_(rays_of_a_station(options.count)),
        view_(scene_),
        noise_(mix_bits(~options.seed)),
        starts_(mix_bits(~options.seed) + 1) {
    begin_station();
  }

  // The view looks at this scene.
  Scan(const Scan&) = delete;
  Scan& operator=(const Scan&) = delete;

  std::size_t next(std::span<Point<3>> points) override {
    const std::size_t wanted = std::min<std::uint64_t>(points.size(), remaining_);
    std::size_t n = 0;
    while (n < wanted) {
      if (row_ == raster_.rows || view_.is_done()) {
        begin_column();
        continue;
      }
      const Direction elevation = raster_.elevation(row_++);
      if (const auto range = view_.first_hit(elevation)) points[n++] = measured(*range, elevation);
    }
    remaining_ -= n;
    return n;
  }

  [[nodiscard]] const IntegerLattice* lattice() const override { return &kLattice; }

 private:
  static constexpr IntegerLattice kLattice{{kScale, kScale, kScale}, {0, 0, 0}};

  /// A few more than it takes, so that the last station all but finishes its turn.
  [[nodiscard]] double rays_of_a_station(std::uint64_t count) const {
    constexpr double kReserve = 1.003;
    return kReserve * static_cast<double>(count) /
           (share_of_hits(scene_) * static_cast<double>(scene_.stations.size()));
  }

  /// After the last station the first one has its turn again, with other columns.
  void begin_station() {
    station_ = scene_.stations[turn_++ % scene_.stations.size()];
    start_ = starts_.uniform();
    column_ = 0;
    aim();
  }

  void begin_column() {
    if (++column_ == raster_.columns) {
      begin_station();
    } else {
      aim();
    }
  }

  void aim() {
    azimuth_ = raster_.azimuth(column_, start_);
    view_.aim(station_, azimuth_);
    row_ = 0;
  }

  /// The point that the scanner makes of what it hits at that distance.
  Point<3> measured(double range, const Direction& elevation) {
    range += (kLeastNoise + kMoreNoise * (range / kScanRange)) * noise_.next();
    const double level = range * elevation.cosine;
    // All coordinates are positive, so that this rounds down.
    const auto on_lattice = [](double metres) {
      return static_cast<double>(static_cast<std::int64_t>(metres * kStepsPerMetre));
    };
    return {on_lattice(station_[0] + level * azimuth_.cosine),
            on_lattice(station_[1] + level * azimuth_.sine),
            on_lattice(station_[2] + range * elevation.sine)};
  }

  std::uint64_t remaining_;
  ScanScene scene_;
  Raster raster_;
  ScanColumn view_;
  Normals noise_;
  Random starts_;

  std::uint64_t turn_ = 0;
  Point<3> station_{};
  double start_ = 0;  // of the turn's first column, in columns
  std::uint64_t column_ = 0;
  Direction azimuth_{};
  std::uint64_t row_ = 0;
};

}  // namespace

std::unique_ptr<PointGenerator> make_scan(const GeneratorOptions& options) {
  return std::make_unique<Scan>(options);
}

}  // namespace spillway::generators
