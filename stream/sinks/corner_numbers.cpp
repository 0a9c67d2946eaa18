#include "stream/sinks/corner_numbers.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "formats/bytes/number_type.h"
#include "src/geometry/longest_edge.h"
#include "src/parallel/parallel.h"

namespace spillway::stream {
namespace {

constexpr std::size_t kTrianglesAtATime = 4096;
constexpr std::uint32_t kSide = RasterStore::kSide;

std::uint32_t tiles_across(const PixelGrid& grid) { return (grid.columns + kSide - 1) / kSide; }

}  // namespace

CornerNumbers::CornerNumbers(const AttributeLayout& layout, std::span<const std::string> names,
                             const std::optional<IntegerLattice>& on_lattice,
                             std::optional<double> max_edge, std::uint64_t memory,
                             ScratchFolder& scratch)
    : record_size_(layout.record_size()),
      lattice_(on_lattice),
      max_edge_(max_edge),
      memory_(memory),
      scratch_(scratch) {
  for (const std::string& name : names) fields_.push_back(*layout.find(name));
}

std::array<float, 3> CornerNumbers::numbers_in(const std::byte* record) const {
  std::array<float, 3> numbers{};
  for (std::size_t i = 0; i < fields_.size(); ++i) {
    const double number = load_number(fields_[i].attribute.type, record + fields_[i].at);
    numbers[i] = std::max(0.0F, static_cast<float>(number));
  }
  return numbers;
}

void CornerNumbers::begin(const PixelGrid& grid) {
  grid_ = grid;
  largest_ = 0;
  centres_.emplace(grid_, lattice_);
  store_.emplace(std::vector<PixelRule>(fields_.size(), PixelRule::kPreferred), memory_, scratch_);
}

void CornerNumbers::paint(std::span<const NumberedVertex> vertices,
                          std::span<const std::uint32_t> corners) {
  float largest = 0;
  for (const NumberedVertex& vertex : vertices) {
    largest = std::max(largest, std::ranges::max(vertex.numbers));
  }
  float before = largest_;
  while (before < largest && !largest_.compare_exchange_weak(before, largest)) {
  }
  const auto paint_some = [&](std::size_t /*grain*/, std::size_t begin, std::size_t end) {
    RasterStore::Hand hand(*store_);
    std::vector<PixelRun> runs;
    for (std::size_t t = begin; t < end; ++t) {
      const std::uint32_t* const v = &corners[3 * t];
      paint_triangle({&vertices[v[0]], &vertices[v[1]], &vertices[v[2]]}, hand, runs);
    }
  };
  // Isolated: the caller may hold what another of its tasks would wait for.
  isolated([&] { parallel_for(corners.size() / 3, kTrianglesAtATime, paint_some); });
}

bool CornerNumbers::is_too_long(const std::array<const NumberedVertex*, 3>& corners) const {
  if (!max_edge_) return false;
  std::array<Point<2>, 3> places{};
  for (std::size_t i = 0; i < 3; ++i) {
    const PlacedPoint& place = corners[i]->place;
    places[i] = {place[0], place[1]};
    if (lattice_) {
      places[i] = {lattice_->to_world(0, place[0]), lattice_->to_world(1, place[1])};
    }
  }
  return has_longer_edge<2>(places, *max_edge_);
}

void CornerNumbers::paint_triangle(const std::array<const NumberedVertex*, 3>& corners,
                                   RasterStore::Hand& hand, std::vector<PixelRun>& runs) const {
  std::array<CentreWindow, 3> windows{};
  Triangle triangle{};
  for (std::size_t i = 0; i < 3; ++i) {
    const PlacedPoint& place = corners[i]->place;
    windows[i] = centres_around(*centres_, place);
    // Instead of a height, which corner it is: a triangle is put in order by x and y.
    triangle[i] = {place[0], place[1], static_cast<double>(i)};
  }
  const PixelWindow window = window_of(windows[0], windows[1], windows[2]);
  if (window.empty() || is_too_long(corners)) return;
  const Triangle canonical = in_canonical_order(triangle);
  find_pixels(*centres_, canonical, window, runs);
  const Point<2> scale =
      lattice_ ? Point<2>{lattice_->scale[0], lattice_->scale[1]} : Point<2>{1, 1};
  const auto nearest_to = [&](double x, double y) {
    std::size_t nearest = 0;
    double least = std::numeric_limits<double>::infinity();
    for (const Point<3>& corner : canonical) {
      const double east = (x - corner[0]) * scale[0];
      const double north = (y - corner[1]) * scale[1];
      const double away = east * east + north * north;
      if (away >= least) continue;
      least = away;
      nearest = static_cast<std::size_t>(corner[2]);
    }
    return nearest;
  };
  for (const PixelRun& run : runs) {
    const double y = centres_->y()[run.row];
    for (std::uint32_t column = run.begin; column < run.end; ++column) {
      const std::array<float, 3>& numbers = corners[nearest_to(centres_->x()[column], y)]->numbers;
      float* const tile =
          hand.tile(std::uint64_t{run.row / kSide} * tiles_across(grid_) + column / kSide);
      float* pixel = tile + std::size_t{run.row % kSide} * kSide + column % kSide;
      for (std::size_t b = 0; b < fields_.size(); ++b, pixel += RasterStore::kTilePixels) {
        put_pixel(*pixel, numbers[b], PixelRule::kPreferred, run.owned);
      }
    }
  }
}

void CornerNumbers::take_all(const Visit& visit) {
  std::vector<float> pixels;
  for (const std::uint64_t number : store_->tiles()) {
    store_->take(number, pixels);
    const auto first_row = static_cast<std::uint32_t>(number / tiles_across(grid_)) * kSide;
    const auto first_column = static_cast<std::uint32_t>(number % tiles_across(grid_)) * kSide;
    for (std::uint32_t i = 0; i < RasterStore::kTilePixels; ++i) {
      if (std::isnan(pixels[i])) continue;
      std::array<float, 3> numbers{};
      for (std::size_t b = 0; b < fields_.size(); ++b) {
        numbers[b] = pixels[b * RasterStore::kTilePixels + i];
      }
      visit(first_column + i % kSide, first_row + i / kSide, numbers);
    }
  }
}

}  // namespace spillway::stream
