#include "src/picture/polygons.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>
#include <utility>
#include <vector>

#include "src/parallel/parallel.h"

namespace spillway::picture {
namespace {

/// Samples of a pixel, each way.
constexpr std::uint32_t kSamples = 3;
/// Rows of pixels that one task draws.
constexpr std::uint32_t kBandRows = 16;
/// Half the width of a line along an edge, on one side of it.
constexpr double kLineWidth = 0.5;

/// Twice the area, positive if corners run clockwise as seen.
double doubled_area(const SeenPolygon& polygon) {
  double area = 0;
  for (int i = 0; i < polygon.count; ++i) {
    const Point<3>& a = polygon.corners[i];
    const Point<3>& b = polygon.corners[(i + 1) % polygon.count];
    area += a[0] * b[1] - b[0] * a[1];
  }
  return area;
}

/// On which side of an edge points are, evaluated in the same way from both of its polygons.
class Side {
 public:
  Side() = default;

  /// The inside has positive distances if the polygon's corners run clockwise as seen and `turn` is
  /// 1, or counter-clockwise and it is -1.
  Side(Point<2> a, Point<2> b, double turn) {
    const bool swapped = b < a;
    if (swapped) std::swap(a, b);
    from_ = a;
    way_ = {b[0] - a[0], b[1] - a[1]};
    const double length = std::hypot(way_[0], way_[1]);
    if (length > 0) {
      scale_ = (swapped ? -turn : turn) / length;
    } else {
      offset_ = std::numeric_limits<double>::infinity();  // no side at all
    }
  }

  /// In pixels.
  [[nodiscard]] double distance(double x, double y) const {
    return offset_ + scale_ * (way_[0] * (y - from_[1]) - way_[1] * (x - from_[0]));
  }

 private:
  Point<2> from_{};
  Point<2> way_{};
  double scale_ = 0;
  double offset_ = 0;
};

/// Where in a picture a polygon is.
struct Outline {
  std::array<Side, 4> sides;
  Point<3> first{};
  Point<2> slope{};  ///< of nearness
};

Outline outline_of(const SeenPolygon& polygon) {
  Outline outline;
  const double turn = doubled_area(polygon) < 0 ? -1 : 1;
  for (int i = 0; i < polygon.count; ++i) {
    const Point<3>& a = polygon.corners[i];
    const Point<3>& b = polygon.corners[(i + 1) % polygon.count];
    outline.sides[i] = Side({a[0], a[1]}, {b[0], b[1]}, turn);
  }
  outline.first = polygon.corners[0];
  const Point<3>& a = polygon.corners[1];
  const Point<3>& b = polygon.corners[2];
  const Point<3>& o = outline.first;
  const double area = (a[0] - o[0]) * (b[1] - o[1]) - (b[0] - o[0]) * (a[1] - o[1]);
  if (area != 0) {
    const double da = a[2] - o[2];
    const double db = b[2] - o[2];
    outline.slope = {(da * (b[1] - o[1]) - db * (a[1] - o[1])) / area,
                     (db * (a[0] - o[0]) - da * (b[0] - o[0])) / area};
  }
  return outline;
}

/// The samples of some rows of pixels.
class Band {
 public:
  Band(std::uint32_t columns, std::uint32_t first_row, std::uint32_t rows)
      : columns_(columns * kSamples),
        first_row_(first_row * kSamples),
        rows_(rows * kSamples),
        samples_(std::size_t{columns_} * rows_) {}

  void draw(const SeenPolygon& polygon) {
    Point<2> lo = {polygon.corners[0][0], polygon.corners[0][1]};
    Point<2> hi = lo;
    for (int i = 1; i < polygon.count; ++i) {
      for (int k = 0; k < 2; ++k) {
        lo[k] = std::min(lo[k], polygon.corners[i][k]);
        hi[k] = std::max(hi[k], polygon.corners[i][k]);
      }
    }
    const auto [row, row_end] = samples_between(lo[1], hi[1], first_row_, first_row_ + rows_);
    const auto [column, column_end] = samples_between(lo[0], hi[0], 0, columns_);
    if (row >= row_end || column >= column_end || doubled_area(polygon) == 0) return;
    const Outline outline = outline_of(polygon);
    for (std::uint32_t r = row; r < row_end; ++r) {
      for (std::uint32_t c = column; c < column_end; ++c) draw_sample(polygon, outline, c, r);
    }
  }

  /// Puts the pixels' means into the picture.
  void put(Picture& picture) const {
    for (std::uint32_t row = 0; row < rows_ / kSamples; ++row) {
      for (std::uint32_t column = 0; column < picture.columns(); ++column) {
        Colour sum{};
        float covered = 0;
        for (std::uint32_t s = 0; s < kSamples * kSamples; ++s) {
          const Sample& sample = samples_[std::size_t{row * kSamples + s / kSamples} * columns_ +
                                          column * kSamples + s % kSamples];
          if (std::isinf(sample.nearness)) continue;
          for (std::size_t k = 0; k < 3; ++k) sum[k] += sample.colour[k];
          ++covered;
        }
        if (covered == 0) continue;
        for (float& channel : sum) channel /= covered;
        picture.set(column, first_row_ / kSamples + row, sum, covered / (kSamples * kSamples));
      }
    }
  }

 private:
  struct Sample {
    double nearness = -std::numeric_limits<double>::infinity();
    Colour colour{};
  };

  struct Range {
    std::uint32_t begin;
    std::uint32_t end;
  };

  /// The samples from `first` to before `end` whose places, in pixels, are from `lo` to `hi`.
  static Range samples_between(double lo, double hi, std::uint32_t first, std::uint32_t end) {
    const double before = std::ceil(lo * kSamples - 0.5);
    const double behind = std::floor(hi * kSamples - 0.5) + 1;
    const auto kept = [&](double place) {
      return static_cast<std::uint32_t>(
          std::clamp(place, static_cast<double>(first), static_cast<double>(end)));
    };
    return {kept(before), kept(behind)};
  }

  static double place_of(std::uint32_t sample) { return (sample + 0.5) / kSamples; }

  void draw_sample(const SeenPolygon& polygon, const Outline& outline, std::uint32_t column,
                   std::uint32_t row) {
    const double x = place_of(column);
    const double y = place_of(row);
    double inside = std::numeric_limits<double>::infinity();
    for (int i = 0; i < polygon.count; ++i) {
      inside = std::min(inside, outline.sides[i].distance(x, y));
      if (inside < 0) return;
    }
    const double nearness = outline.first[2] + outline.slope[0] * (x - outline.first[0]) +
                            outline.slope[1] * (y - outline.first[1]);
    // Soft over the width of a sample, lest some lines look wider than others.
    const auto line =
        static_cast<float>(std::clamp((kLineWidth - inside) * kSamples + 0.5, 0.0, 1.0));
    const Colour colour = mix(polygon.colour, kEdgeColour, line * polygon.edge_opacity);
    Sample& sample = samples_[std::size_t{row - first_row_} * columns_ + column];
    if (std::tie(nearness, colour) > std::tie(sample.nearness, sample.colour)) {
      sample = {nearness, colour};
    }
  }

  static constexpr Colour kEdgeColour = {0.08F, 0.10F, 0.14F};

  std::uint32_t columns_;
  std::uint32_t first_row_;
  std::uint32_t rows_;
  std::vector<Sample> samples_;
};

}  // namespace

double side_of(const SeenPolygon& polygon) {
  return std::sqrt(std::abs(doubled_area(polygon)) / 2);
}

Picture draw_polygons(std::span<const SeenPolygon> polygons, std::uint32_t columns,
                      std::uint32_t rows) {
  Picture picture(columns, rows);
  parallel_for(rows, kBandRows, [&](std::size_t, std::size_t begin, std::size_t end) {
    Band band(columns, static_cast<std::uint32_t>(begin), static_cast<std::uint32_t>(end - begin));
    for (const SeenPolygon& polygon : polygons) band.draw(polygon);
    band.put(picture);
  });
  return picture;
}

}  // namespace spillway::picture
