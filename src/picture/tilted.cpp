#include "src/picture/tilted.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "src/error.h"
#include "src/geometry/box.h"
#include "src/parallel/parallel.h"
#include "src/picture/frame.h"

namespace spillway::picture {
namespace {

constexpr std::uint32_t kSamples = 3;
constexpr std::size_t kRowsAtATime = 4;

/// Where the terrain is cut off.
constexpr Colour kCutColour = {0.50F, 0.46F, 0.42F};

/// Along a ray, in nodes of the field.
constexpr double kStep = 0.5;

/// Directions in units of the field, from its middle: east, north, up.
struct Axes {
  explicit Axes(const TiltedView& view) {
    const double azimuth = view.azimuth * std::numbers::pi / 180;
    const double elevation = view.elevation * std::numbers::pi / 180;
    right = {-std::cos(azimuth), std::sin(azimuth), 0};
    up = {-std::sin(azimuth) * std::sin(elevation), -std::cos(azimuth) * std::sin(elevation),
          std::cos(elevation)};
    towards = {std::sin(azimuth) * std::cos(elevation), std::cos(azimuth) * std::cos(elevation),
               std::sin(elevation)};
  }
  Point<3> right{};
  Point<3> up{};
  Point<3> towards{};
};

/// Shortens a range of a ray to where `from + t * way` lies from 0 to `most`.
void clip(double from, double way, double most, double& near, double& far) {
  if (std::abs(way) < 1e-12) {
    if (from < 0 || from > most) near = far - 1;
    return;
  }
  const auto [begin, end] = std::minmax({-from / way, (most - from) / way});
  near = std::min(near, end);
  far = std::max(far, begin);
}

class Caster {
 public:
  Caster(const Picture& map, const HeightField& field, const TiltedView& view)
      : map_(map),
        field_(field),
        axes_(view),
        middle_{(field.columns() - 1) / 2.0, (field.rows() - 1) / 2.0} {}

  /// The box around all that is seen: to the right and upwards.
  [[nodiscard]] Box<2> seen_box() const {
    Box<2> box;
    for (std::uint32_t row = 0; row < field_.rows(); ++row) {
      for (std::uint32_t column = 0; column < field_.columns(); ++column) {
        const float node = field_.node(std::size_t{row} * field_.columns() + column);
        if (std::isnan(node)) continue;
        for (const double z : {0.0, double{node}}) {
          const Point<3> place = {column - middle_[0], middle_[1] - row, z};
          box.expand(Point<2>{dot(place, axes_.right), dot(place, axes_.up)});
        }
      }
    }
    return box;
  }

  /// The colour that is seen at a place to the right and upwards; nothing if no terrain is there.
  [[nodiscard]] std::optional<Colour> look(double right, double up) const {
    const Point<3>& towards = axes_.towards;
    const double column = middle_[0] + right * axes_.right[0] + up * axes_.up[0];
    const double row = middle_[1] - right * axes_.right[1] - up * axes_.up[1];
    const double height = up * axes_.up[2];
    // From where the ray comes to the highest place to where it comes to the lowest.
    double near = (field_.top() + kTouching - height) / towards[2];
    double far = (-kTouching - height) / towards[2];
    clip(column, towards[0], field_.columns() - 1.0, near, far);
    clip(row, -towards[1], field_.rows() - 1.0, near, far);
    if (near < far) return std::nullopt;
    const double level_way = (near - far) * std::hypot(towards[0], towards[1]);
    const double steps = std::max(1.0, std::ceil(level_way / kStep));
    const auto place = [&](double step) {
      const double t = near + (far - near) * (step / steps);
      return Point<3>{column + t * towards[0], row - t * towards[1], height + t * towards[2]};
    };
    const double skipped = std::floor(HeightField::kReach / kStep);
    double above_before = -1;  // of the step before, as far as it is over the terrain
    for (double step = 0; step <= steps; ++step) {
      const Point<3> here = place(step);
      const double end = std::min(step + skipped, steps);
      if (end > step + 1 && place(end)[2] > field_.most_near(here[0], here[1])) {
        step = end - 1;
        above_before = -1;
        continue;
      }
      const double above = here[2] - field_.height(here[0], here[1]);
      if (above <= 0 && above_before > 0) {
        const Point<3> hit = place(step - above / (above - above_before));
        return colour_at_place(hit[0], hit[1]);
      }
      if (above < 0) return kCutColour;
      above_before = std::isnan(above) ? -1 : std::max(above, kTouching);
    }
    return std::nullopt;
  }

 private:
  /// Rays begin so far above the highest place and end so far below the lowest one.
  static constexpr double kTouching = 1e-6;

  static double dot(const Point<3>& a, const Point<3>& b) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
  }

  [[nodiscard]] Colour colour_at_place(double column, double row) const {
    const auto c = static_cast<std::uint32_t>(std::clamp(column, 0.0, field_.columns() - 1.0));
    const auto r = static_cast<std::uint32_t>(std::clamp(row, 0.0, field_.rows() - 1.0));
    const std::uint32_t east = std::min(c + 1, field_.columns() - 1);
    const std::uint32_t south = std::min(r + 1, field_.rows() - 1);
    const auto x = static_cast<float>(column - c);
    const auto y = static_cast<float>(row - r);
    return mix(mix(map_.colour(c, r), map_.colour(east, r), x),
               mix(map_.colour(c, south), map_.colour(east, south), x), y);
  }

  const Picture& map_;
  const HeightField& field_;
  const Axes axes_;
  const Point<2> middle_;
};

}  // namespace

Picture draw_tilted(const Picture& map, const HeightField& field, const TiltedView& view) {
  const Caster caster(map, field, view);
  const Box<2> box = caster.seen_box();
  if (!(std::max(box.extent(0), box.extent(1)) > 0)) {
    throw Failure("nothing is seen: the terrain is less than two pixels large",
                  ErrorCode::kDegenerateInput);
  }
  const PixelGrid frame = frame_around(box, view.size, view.margin);
  Picture picture(frame.columns, frame.rows);
  parallel_for(frame.rows, kRowsAtATime, [&](std::size_t, std::size_t begin, std::size_t end) {
    for (auto row = static_cast<std::uint32_t>(begin); row < end; ++row) {
      for (std::uint32_t column = 0; column < frame.columns; ++column) {
        Colour sum{};
        float hits = 0;
        for (std::uint32_t s = 0; s < kSamples * kSamples; ++s) {
          const std::uint32_t sample_row = s / kSamples;
          const double across = column + (s % kSamples + 0.5) / kSamples;
          const double down = row + (sample_row + 0.5) / kSamples;
          const auto colour = caster.look(frame.west + across * frame.resolution,
                                          frame.north - down * frame.resolution);
          if (!colour) continue;
          for (std::size_t k = 0; k < sum.size(); ++k) sum[k] += (*colour)[k];
          ++hits;
        }
        if (hits == 0) continue;
        for (float& channel : sum) channel /= hits;
        picture.set(column, row, sum, hits / (kSamples * kSamples));
      }
    }
  });
  return picture;
}

}  // namespace spillway::picture
