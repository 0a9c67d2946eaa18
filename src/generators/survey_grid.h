#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "src/geometry/box.h"
#include "src/geometry/point.h"

namespace spillway::generators {

/// What a survey is cut into.
struct SurveyGridShape {
  std::size_t columns = 1;  ///< along x
  std::size_t rows = 1;     ///< along y
  /// Width of the strip along each inner line that its neighbours share, in sides of a mean tile.
  /// At most 0.4: up to there the strips of two lines do not meet.
  double overlap = 0;
};

/// The tiles of a survey, as an office delivers them: rectangles of uneven sizes whose boxes
/// overlap. Each point belongs to one tile; in a strip along a line its number decides to which
/// neighbour. A tile is 0.4 to 1.6 sides of a mean one long and wide, its strips apart. Described
/// in docs/generators.md.
class SurveyGrid {
 public:
  /// `extent` is the box of all points. The same arguments give the same grid on every machine.
  SurveyGrid(const Box<3>& extent, const SurveyGridShape& shape, std::uint64_t seed);

  /// How many tiles there are.
  [[nodiscard]] std::size_t size() const { return (x_.lines.size() + 1) * (y_.lines.size() + 1); }

  /// The tile of the point of that number: row * columns + column, from the south-west corner on.
  [[nodiscard]] std::size_t tile_of(const Point<3>& point, std::uint64_t index) const;

 private:
  struct Axis {
    std::vector<double> lines;  ///< inner ones, ascending
    double half_strip = 0;
  };

  static Axis make_axis(double lo, double hi, std::size_t tiles, double overlap,
                        std::uint64_t seed);
  static std::size_t place_on(const Axis& axis, double coordinate, bool beyond);

  Axis x_, y_;
  std::uint64_t seed_;
};

}  // namespace spillway::generators
