#include "src/terrain/triangle_pixels.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "src/geometry/predicate_stages.h"

namespace spillway::terrain {
namespace {

/// The edges of a triangle, by their corners.
constexpr std::array<std::array<int, 2>, 3> kEdges = {{{0, 1}, {0, 2}, {1, 2}}};

class Scan {
 public:
  Scan(const PixelCentres& centres, const Triangle& corners, int turn, std::vector<PixelRun>& runs)
      : centres_(centres), corners_(corners), turn_(turn), runs_(runs) {
    const double extent = corners[2][0] - corners[0][0];
    margin_ = kMarginRoundoffs * stages::kRoundoff *
              (std::max(std::abs(corners[0][0]), std::abs(corners[2][0])) + extent);
    for (int e = 0; e < 3; ++e) {
      const Point<3>& from = corners[kEdges[e][0]];
      const Point<3>& to = corners[kEdges[e][1]];
      if (to[1] == from[1]) continue;
      slopes_[e] = (to[0] - from[0]) / (to[1] - from[1]);
      if (!std::isfinite(slopes_[e])) margin_ = std::numeric_limits<double>::infinity();
    }
  }

  void scan_row(std::uint32_t row, std::uint32_t begin, std::uint32_t end) {
    const auto [left, right, on_edge] = crossings(centres_.y()[row]);
    const std::span<const double> x = centres_.x();
    std::uint32_t column = std::max(begin, centres_.first_column(left - margin_));
    const double doubtful_end = (on_edge ? right : std::min(left, right)) + margin_;
    while (column < end && x[column] <= doubtful_end) locate(row, column++);
    const std::uint32_t inside_end =
        std::min(end, std::max(column, centres_.first_column(right - margin_)));
    if (column < inside_end) runs_.push_back({row, column, inside_end});
    for (column = std::max(column, inside_end); column < end && x[column] <= right + margin_;) {
      locate(row, column++);
    }
  }

 private:
  /// The crossing of an edge and a row is off by at most 3 roundings of its distance to a corner
  /// and one of itself; this is generous.
  static constexpr double kMarginRoundoffs = 16;

  /// Where the triangle begins and ends on a row.
  struct Crossings {
    double left = std::numeric_limits<double>::infinity();
    double right = -std::numeric_limits<double>::infinity();
    bool on_edge = false;  ///< an edge runs along the row
  };

  /// But for rounding.
  [[nodiscard]] Crossings crossings(double y) const {
    Crossings found;
    for (int e = 0; e < 3; ++e) {
      const Point<3>& from = corners_[kEdges[e][0]];
      const Point<3>& to = corners_[kEdges[e][1]];
      if (y < std::min(from[1], to[1]) || y > std::max(from[1], to[1])) continue;
      if (from[1] == to[1]) return {from[0], to[0], true};
      const double x = from[0] + (y - from[1]) * slopes_[e];
      found.left = std::min(found.left, x);
      found.right = std::max(found.right, x);
    }
    return found;
  }

  /// Decides exactly about one centre.
  void locate(std::uint32_t row, std::uint32_t column) {
    const double x = centres_.x()[column];
    const double y = centres_.y()[row];
    const auto found = terrain::locate(corners_, turn_, x, y);
    if (found) runs_.push_back({row, column, column + 1, found->relation, found->owned});
  }

  const PixelCentres& centres_;
  const Triangle& corners_;
  const int turn_;
  std::vector<PixelRun>& runs_;
  std::array<double, 3> slopes_{};
  double margin_;
};

}  // namespace

CentreWindow centres_around(const PixelCentres& centres, const Point<3>& vertex) {
  CentreWindow window;
  window.column_begin = window.column_end = centres.first_column(vertex[0]);
  window.row_begin = window.row_end = centres.first_row(vertex[1]);
  // Centres are distinct: at most one is at the vertex.
  if (window.column_end < centres.x().size() && centres.x()[window.column_end] == vertex[0]) {
    ++window.column_end;
  }
  if (window.row_end < centres.y().size() && centres.y()[window.row_end] == vertex[1]) {
    ++window.row_end;
  }
  return window;
}

void find_pixels(const PixelCentres& centres, const Triangle& canonical, const PixelWindow& window,
                 std::vector<PixelRun>& runs) {
  runs.clear();
  if (window.empty()) return;
  const int turn = turn_of(canonical);
  if (turn == 0) return;
  Scan scan(centres, canonical, turn, runs);
  for (std::uint32_t row = window.row_begin; row < window.row_end; ++row) {
    scan.scan_row(row, window.column_begin, window.column_end);
  }
}

}  // namespace spillway::terrain
