#include "src/terrain/polygon_pixels.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <utility>

namespace spillway::terrain {
namespace {

/// Where an edge crosses a row: the first column whose centre is not west of it.
struct Crossing {
  std::uint32_t row;
  std::uint32_t column;

  // NOLINTNEXTLINE(modernize-use-nullptr): a false finding in what the compiler generates
  auto operator<=>(const Crossing&) const = default;  // NOLINT(modernize-use-nullptr)
};

std::uint32_t clamped(double number, std::uint32_t most) {
  if (!(number > 0)) return 0;
  return number < most ? static_cast<std::uint32_t>(number) : most;
}

std::uint32_t first_column(const PixelGrid& raster, double x) {
  std::uint32_t c = clamped((x - raster.west) / raster.resolution, raster.columns);
  while (c > 0 && raster.centre_x(c - 1) >= x) --c;
  while (c < raster.columns && raster.centre_x(c) < x) ++c;
  return c;
}

/// The first row whose centre is south of y.
std::uint32_t first_row(const PixelGrid& raster, double y) {
  std::uint32_t r = clamped((raster.north - y) / raster.resolution, raster.rows);
  while (r > 0 && raster.centre_y(r - 1) < y) --r;
  while (r < raster.rows && raster.centre_y(r) >= y) ++r;
  return r;
}

/// Of the edge between two corners, whichever comes first: neighbours compute the same.
void add_crossings(const PixelGrid& raster, const Point<2>& a, const Point<2>& b,
                   std::vector<Crossing>& crossings) {
  if (a[1] == b[1]) return;
  const auto& [low, high] = a[1] < b[1] ? std::pair(a, b) : std::pair(b, a);
  const double slope = (high[0] - low[0]) / (high[1] - low[1]);
  const std::uint32_t end = first_row(raster, low[1]);
  for (std::uint32_t row = first_row(raster, high[1]); row < end; ++row) {
    const double x = low[0] + (raster.centre_y(row) - low[1]) * slope;
    crossings.push_back({row, first_column(raster, x)});
  }
}

}  // namespace

PolygonPixels::PolygonPixels(std::span<const std::vector<Point<2>>> rings,
                             const PixelGrid& raster) {
  std::vector<Crossing> crossings;
  for (const std::vector<Point<2>>& ring : rings) {
    for (std::size_t i = 0; i < ring.size(); ++i) {
      add_crossings(raster, ring[i], ring[(i + 1) % ring.size()], crossings);
    }
  }
  std::ranges::sort(crossings);
  std::vector<std::uint32_t> rows;
  for (std::size_t i = 0; i + 1 < crossings.size(); i += 2) {
    const auto [row, begin] = crossings[i];
    const std::uint32_t end = crossings[i + 1].column;
    if (begin == end) continue;
    if (!rows.empty() && rows.back() == row && runs_.back().end == begin) {
      runs_.back().end = end;
      continue;
    }
    rows.push_back(row);
    runs_.push_back({begin, end});
  }
  complete(rows);
}

PolygonPixels::PolygonPixels(std::span<const PolygonPixels> several, bool outside,
                             const PixelGrid& raster) {
  std::vector<std::uint32_t> rows;
  std::vector<ColumnRun> inside;
  std::vector<const PolygonPixels*> next;  // by their first rows
  for (const PolygonPixels& pixels : several) next.push_back(&pixels);
  const auto first_row = [](const PolygonPixels* pixels) { return pixels->window_.row_begin; };
  std::ranges::stable_sort(next, {}, first_row);
  std::vector<const PolygonPixels*> here;  // those that may have pixels in the row
  auto coming = next.begin();
  for (std::uint32_t row = 0; row < raster.rows; ++row) {
    inside.clear();
    for (; coming != next.end() && first_row(*coming) <= row; ++coming) here.push_back(*coming);
    std::erase_if(here,
                  [&](const PolygonPixels* pixels) { return pixels->window_.row_end <= row; });
    for (const PolygonPixels* const pixels : here) {
      const std::span<const ColumnRun> runs = pixels->row(row);
      inside.insert(inside.end(), runs.begin(), runs.end());
    }
    std::ranges::sort(inside, {}, &ColumnRun::begin);
    std::uint32_t end = 0;  // of the runs so far
    const std::size_t before = runs_.size();
    for (const ColumnRun& run : inside) {
      if (outside) {
        if (run.begin > end) runs_.push_back({end, run.begin});
      } else if (runs_.size() > before && run.begin <= end) {
        runs_.back().end = std::max(end, run.end);
      } else {
        runs_.push_back(run);
      }
      end = std::max(end, run.end);
    }
    if (outside && end < raster.columns) runs_.push_back({end, raster.columns});
    rows.resize(runs_.size(), row);
  }
  complete(rows);
}

/// Finds where rows begin, of runs that are in these rows.
void PolygonPixels::complete(const std::vector<std::uint32_t>& rows) {
  if (runs_.empty()) {
    first_run_ = {0};
    return;
  }
  window_ = {rows.front(), rows.back() + 1, std::ranges::min(runs_, {}, &ColumnRun::begin).begin,
             std::ranges::max(runs_, {}, &ColumnRun::end).end};
  for (std::uint32_t row = window_.row_begin; row <= window_.row_end; ++row) {
    first_run_.push_back(
        static_cast<std::size_t>(std::ranges::lower_bound(rows, row) - rows.begin()));
  }
}

bool PolygonPixels::has(std::uint32_t row, std::uint32_t column) const {
  if (row < window_.row_begin || row >= window_.row_end) return false;
  const std::span<const ColumnRun> runs = this->row(row);
  const auto next = std::ranges::upper_bound(runs, column, {}, &ColumnRun::begin);
  return next != runs.begin() && column < std::prev(next)->end;
}

}  // namespace spillway::terrain
