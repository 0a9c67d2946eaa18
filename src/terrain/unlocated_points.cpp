#include "src/terrain/unlocated_points.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "src/terrain/pixel_values.h"

namespace spillway::terrain {
namespace {

constexpr double kPlacesOfACell = 2;
/// Crossings of edges and rows are off by some roundings of coordinates; this is generous.
constexpr double kMarginRoundoffs = 64;

double margin_of(double a, double b) {
  return kMarginRoundoffs * std::numeric_limits<double>::epsilon() * (std::abs(a) + std::abs(b));
}

std::size_t cell_of(double distance, double cells_per_unit, std::size_t cells) {
  const double cell = distance * cells_per_unit;
  if (!(cell > 0)) return 0;
  return cell < static_cast<double>(cells) ? static_cast<std::size_t>(cell) : cells - 1;
}

/// 0 where all places have one coordinate.
double per_unit(std::size_t cells, double extent) {
  return extent > 0 ? static_cast<double>(cells) / extent : 0;
}

}  // namespace

void UnlocatedPoints::assign(std::span<const NumberedPlace> places) {
  places_.resize(places.size());
  size_ = places.size();
  box_ = {};
  for (const NumberedPlace& place : places) box_.expand(Point<2>{place.x, place.y});
  const double width = box_.extent(0);
  const double height = box_.extent(1);
  const double wanted = std::max(1.0, static_cast<double>(places.size()) / kPlacesOfACell);
  const double across =
      width > 0 && height > 0 ? std::sqrt(wanted * width / height) : (width > 0 ? wanted : 1.0);
  columns_ = static_cast<std::size_t>(std::clamp(across, 1.0, wanted));
  rows_ = static_cast<std::size_t>(
      std::clamp(wanted / static_cast<double>(columns_), 1.0, height > 0 ? wanted : 1.0));
  cells_per_x_ = per_unit(columns_, width);
  cells_per_y_ = per_unit(rows_, height);
  cells_.assign(rows_ * columns_, {});
  const auto cell_at = [&](const NumberedPlace& place) -> Cell& {
    return cells_[row_of(place.y) * columns_ + column_of(place.x)];
  };
  for (const NumberedPlace& place : places) ++cell_at(place).end;
  std::uint32_t begin = 0;
  for (Cell& cell : cells_) {
    const std::uint32_t count = cell.end;
    cell = {begin, begin};
    begin += count;
  }
  for (const NumberedPlace& place : places) places_[cell_at(place).end++] = place;
}

std::size_t UnlocatedPoints::row_of(double y) const {
  return cell_of(y - box_.lo[1], cells_per_y_, rows_);
}

std::size_t UnlocatedPoints::column_of(double x) const {
  return cell_of(x - box_.lo[0], cells_per_x_, columns_);
}

/// The cells of a row that the triangle reaches, and maybe one more on each side.
UnlocatedPoints::Columns UnlocatedPoints::columns_in_row(const Triangle& triangle,
                                                         const Box<2>& box, std::size_t row) const {
  const double height = 1 / cells_per_y_;
  const double margin_y = margin_of(box.lo[1], box.hi[1]) + margin_of(box_.lo[1], box_.hi[1]);
  const double bottom = box_.lo[1] + static_cast<double>(row) * height - margin_y;
  const double top = box_.lo[1] + static_cast<double>(row + 1) * height + margin_y;
  double left = std::numeric_limits<double>::infinity();
  double right = -left;
  for (std::size_t e = 0; e < 3; ++e) {
    const Point<3>& a = triangle[e];
    const Point<3>& b = triangle[(e + 1) % 3];
    const double low = std::max(std::min(a[1], b[1]), bottom);
    const double high = std::min(std::max(a[1], b[1]), top);
    if (low > high) continue;
    if (a[1] == b[1]) {
      left = std::min({left, a[0], b[0]});
      right = std::max({right, a[0], b[0]});
      continue;
    }
    for (const double y : {low, high}) {
      const double x = a[0] + (b[0] - a[0]) * ((y - a[1]) / (b[1] - a[1]));
      left = std::min(left, x);
      right = std::max(right, x);
    }
  }
  const double margin_x = margin_of(box.lo[0], box.hi[0]);
  return {column_of(std::max(left, box.lo[0]) - margin_x),
          column_of(std::min(right, box.hi[0]) + margin_x)};
}

void UnlocatedPoints::take_located(const Triangle& triangle, std::vector<NumberedHeight>& heights) {
  if (size_ == 0) return;
  Box<2> box;
  for (const Point<3>& corner : triangle) box.expand(Point<2>{corner[0], corner[1]});
  if (common_part(box, box_).empty()) return;
  const std::size_t first_row = row_of(box.lo[1]);
  const std::size_t last_row = row_of(box.hi[1]);
  const Columns all{column_of(box.lo[0]), column_of(box.hi[0])};
  const bool is_small = last_row - first_row < 2 || all.last - all.first < 2;
  Triangle canonical;
  std::optional<int> turn;  // when it is first needed, as what follows
  std::optional<TrianglePlane> plane;
  for (std::size_t row = first_row; row <= last_row; ++row) {
    const Columns columns = is_small ? all : columns_in_row(triangle, box, row);
    for (std::size_t column = columns.first; column <= columns.last; ++column) {
      Cell& cell = cells_[row * columns_ + column];
      for (std::uint32_t i = cell.begin; i < cell.end;) {
        const NumberedPlace place = places_[i];
        if (place.x < box.lo[0] || place.x > box.hi[0] || place.y < box.lo[1] ||
            place.y > box.hi[1]) {
          ++i;
          continue;
        }
        if (!turn) {
          canonical = in_canonical_order(triangle);
          turn = turn_of(canonical);
        }
        if (*turn == 0) return;
        const auto found = locate(canonical, *turn, place.x, place.y);
        if (!found) {
          ++i;
          continue;
        }
        if (!plane) plane.emplace(canonical, Point<2>{1, 1});
        heights.push_back({place.number, plane->at(found->relation, place.x, place.y)});
        places_[i] = places_[--cell.end];
        --size_;
      }
    }
  }
}

void UnlocatedPoints::append_to(std::vector<NumberedPlace>& places) const {
  places.reserve(places.size() + size_);
  for (const Cell& cell : cells_) {
    places.insert(places.end(), places_.begin() + cell.begin, places_.begin() + cell.end);
  }
}

}  // namespace spillway::terrain
