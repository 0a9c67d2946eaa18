#include "stream/sinks/dem_output.h"

#include <spillway/dem.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "src/parallel/parallel.h"
#include "stream/sinks/tile_edges.h"

namespace spillway::stream {
namespace {

constexpr float kNothing = std::numeric_limits<float>::quiet_NaN();

std::span<float> band_of(std::vector<float>& pixels, std::size_t band) {
  return std::span(pixels).subspan(band * RasterStore::kTilePixels, RasterStore::kTilePixels);
}

/// The values that readers take for nodata, and what is written in their place. GDAL compares
/// floats but for some roundings (its ARE_REAL_EQUAL()).
struct NodataNeighbourhood {
  explicit NodataNeighbourhood(float nodata) : lowest(nodata), highest(nodata) {
    constexpr float kInfinity = std::numeric_limits<float>::infinity();
    const auto is_taken = [nodata](float value) {
      constexpr double kShare = 2.0 * std::numeric_limits<float>::epsilon();
      return std::abs(double{value} - nodata) < kShare * std::abs(double{value} + nodata);
    };
    while (is_taken(std::nextafter(lowest, -kInfinity))) {
      lowest = std::nextafter(lowest, -kInfinity);
    }
    while (is_taken(std::nextafter(highest, kInfinity))) {
      highest = std::nextafter(highest, kInfinity);
    }
    replacement = std::nextafter(highest, kInfinity);
    if (std::isinf(replacement)) replacement = std::nextafter(lowest, -kInfinity);
  }

  float lowest;
  float highest;
  float replacement;  ///< the next value that is told from nodata
};

/// Puts a tile into its frame.
void fill(std::span<const float> pixels, std::span<float> framed) {
  for (std::size_t row = 0; row < kRasterTile; ++row) {
    std::ranges::copy(pixels.subspan(row * kRasterTile, kRasterTile),
                      framed.begin() + static_cast<std::ptrdiff_t>((row + 1) * kFramedSide + 1));
  }
}

bool is_painted(DemProduct product) {
  return !traits_of(product).of_neighbours && !traits_of(product).of_points;
}

}  // namespace

bool has_neighbours(const std::vector<DemProduct>& products) {
  return std::ranges::any_of(products, [](DemProduct one) { return traits_of(one).of_neighbours; });
}

bool are_of_points(const std::vector<DemProduct>& products) {
  return std::ranges::any_of(products, [](DemProduct one) { return traits_of(one).of_points; });
}

std::vector<DemProduct> layers_of(const std::vector<DemProduct>& products, bool fill_voids) {
  std::vector<DemProduct> layers;
  std::ranges::copy_if(products, std::back_inserter(layers), is_painted);
  if ((fill_voids || has_neighbours(products)) &&
      std::ranges::find(layers, DemProduct::kHeight) == layers.end()) {
    layers.push_back(DemProduct::kHeight);
  }
  return layers;
}

/// A tile on its way.
struct DemOutput::Slot {
  std::uint64_t position = 0;  ///< of the tile that is taken in order
  std::vector<std::vector<std::byte>> others;
  std::vector<float> layers;
  std::vector<float> framed;  ///< heights
  std::vector<float> bands;
  SheetContent content;
  std::uint64_t filled = 0;
};

DemOutput::DemOutput(const DemSinkOptions& options, const std::vector<DemProduct>& layers,
                     const TileLayout& tiles, const PolygonPixels* outline, RasterStore& store,
                     std::size_t slots)
    : options_(options),
      layers_(layers),
      tiles_(tiles),
      outline_(outline),
      store_(store),
      slots_(slots),
      light_direction_(direction_of(options.light)),
      multi_shade_(options.light.altitude) {
  for (std::size_t b = 0; b < options_.products.size(); ++b) {
    const DemProduct product = options_.products[b];
    if (traits_of(product).of_neighbours) derived_.push_back({product, b});
  }
  const auto heights = std::ranges::find(layers_, DemProduct::kHeight);
  heights_ = static_cast<std::size_t>(heights - layers_.begin());
}

std::uint64_t DemOutput::bytes(const TileLayout& tiles) {
  if (tiles.margin == 0) return 0;
  return TileEdges::bytes(tiles) + tiles.ring_pixels() * sizeof(float);
}

/// Takes the heights beyond the raster's edges from the store.
void DemOutput::take_ring(const OtherTiles& others) {
  std::vector<float> layers;
  for (std::uint64_t tile = 0; tile < tiles_.ring_tiles(); ++tile) {
    const std::uint64_t number = tiles_.first + tile;
    store_.take(number, layers, others ? others(number) : std::vector<std::vector<std::byte>>{});
    std::ranges::copy(band_of(layers, heights_), std::back_inserter(ring_));
  }
}

/// Puts those that are next to a tile into its frame, or into the tile where the raster ends in it.
void DemOutput::add_ring(std::uint64_t tile, std::span<float> framed) const {
  const std::uint32_t top = tiles_.row(tile) * kRasterTile;
  const std::uint32_t left = tiles_.column(tile) * kRasterTile;
  const auto [rows, columns] = tiles_.size(tile);
  const auto put = [&](std::uint32_t row, std::uint32_t column) {
    if (!tiles_.is_in_ring(top + row, left + column)) return;
    framed[row * kFramedSide + column] = ring_[tiles_.ring_pixel(top + row, left + column)];
  };
  for (std::uint32_t column = 0; column < columns + 2; ++column) {
    put(0, column);
    put(rows + 1, column);
  }
  for (std::uint32_t row = 0; row < rows + 2; ++row) {
    put(row, 0);
    put(row, columns + 1);
  }
}

std::uint64_t DemOutput::slot_bytes(const DemSinkOptions& options,
                                    const std::vector<DemProduct>& layers) {
  const bool are_layers_bands =
      !has_neighbours(options.products) && !are_of_points(options.products);
  const std::size_t bands = layers.size() + (are_layers_bands ? 0 : options.products.size() + 1);
  return bands * RasterStore::kTilePixels * sizeof(float);
}

SheetContent DemOutput::write(Raster& raster,
                              const std::function<void(std::uint64_t pixels)>& progress,
                              const OtherTiles& others) {
  const std::uint64_t tiles = tiles_.count();
  const std::uint64_t delay = derived_.empty() ? 0 : TileEdges::delay(tiles_);
  std::vector<Slot> in_work(slots_);
  TileEdges edges(tiles_);
  take_ring(others);
  std::uint64_t next = 0;
  std::uint64_t done = 0;
  SheetContent content;
  const auto source = [&](std::size_t s) {
    if (next == tiles + delay) return false;
    Slot& slot = in_work[s];
    if (others && next < tiles) slot.others = others(tiles_.stored(next));
    slot.position = next++;
    return true;
  };
  const auto take = [&](std::size_t s) {
    Slot& slot = in_work[s];
    if (slot.position >= tiles) return;
    store_.take(tiles_.stored(slot.position), slot.layers, slot.others);
  };
  const auto look_around = [&](std::size_t s) {
    Slot& slot = in_work[s];
    slot.framed.resize(kFramedSide * kFramedSide);
    if (slot.position < tiles) {
      edges.add(band_of(slot.layers, heights_));
      store_.put_back(tiles_.stored(slot.position), slot.layers);
    }
    if (slot.position >= delay) edges.frame(slot.position - delay, slot.framed);
  };
  const auto tell_of_points = [&](std::size_t s) {
    Slot& slot = in_work[s];
    if (slot.position < delay) return;
    slot.bands.resize(options_.products.size() * RasterStore::kTilePixels);
    points_->make(tiles_.stored(slot.position - delay), slot.bands);
  };
  const auto make = [&](std::size_t s) {
    Slot& slot = in_work[s];
    if (slot.position < delay) return;
    const std::uint64_t tile = slot.position - delay;
    if (delay > 0) store_.take(tiles_.stored(tile), slot.layers);
    make_bands(tile, slot);
  };
  const auto write_tile = [&](std::size_t s) {
    Slot& slot = in_work[s];
    if (slot.position < delay) return;
    const std::uint64_t tile = slot.position - delay;
    for (std::size_t b = 0; b < options_.products.size(); ++b) {
      raster.write_tile(b, tiles_.column(tile), tiles_.row(tile), band_of(slot.bands, b));
    }
    const auto [rows, columns] = tiles_.size(tile);
    done += std::uint64_t{rows} * columns;
    content.pixels_with_data += slot.content.pixels_with_data;
    content.is_empty = content.is_empty && slot.content.is_empty;
    filled_ += slot.filled;
    progress(done);
  };
  std::vector<PipelineStep> steps = {{.in_order = false, .work = take}};
  if (delay > 0) steps.push_back({.in_order = true, .work = look_around});
  if (points_ != nullptr) steps.push_back({.in_order = true, .work = tell_of_points});
  steps.push_back({.in_order = false, .work = make});
  steps.push_back({.in_order = true, .work = write_tile});
  run_pipeline(in_work.size(), source, steps);
  return content;
}

void DemOutput::make_bands(std::uint64_t tile, Slot& slot) const {
  const auto size = tiles_.size(tile);
  if (are_layers_bands()) {
    slot.bands.swap(slot.layers);
  } else {
    slot.bands.resize(options_.products.size() * RasterStore::kTilePixels);
    std::size_t layer = 0;
    for (std::size_t b = 0; b < options_.products.size(); ++b) {
      if (!is_painted(options_.products[b])) continue;
      std::ranges::copy(band_of(slot.layers, layer++), band_of(slot.bands, b).begin());
    }
    if (!derived_.empty()) {
      fill(band_of(slot.layers, heights_), slot.framed);
      add_ring(tile, slot.framed);
      derive(tile, slot);
    }
    if (options_.fill_voids) fill_voids(tile, slot);
  }
  for (std::size_t b = 0; b < options_.products.size(); ++b) {
    finish_band(options_.products[b], size, band_of(slot.bands, b));
  }
  if (outline_ != nullptr) cut_out(tile, slot.bands);
  const auto pixels_with_data = [&](std::size_t b) {
    std::uint64_t count = 0;
    for (std::uint32_t row = 0; row < size.rows; ++row) {
      const auto pixels =
          band_of(slot.bands, b).subspan(std::size_t{row} * kRasterTile, size.columns);
      count += static_cast<std::uint64_t>(std::ranges::count_if(pixels, [&](float pixel) {
        return std::isnan(options_.nodata) ? !std::isnan(pixel) : pixel != options_.nodata;
      }));
    }
    return count;
  };
  slot.content.pixels_with_data = pixels_with_data(0);
  slot.content.is_empty = slot.content.pixels_with_data == 0;
  for (std::size_t b = 1; b < options_.products.size() && slot.content.is_empty; ++b) {
    slot.content.is_empty = pixels_with_data(b) == 0;
  }
}

/// Leaves nothing beside the outline.
void DemOutput::cut_out(std::uint64_t tile, std::vector<float>& bands) const {
  const auto [rows, columns] = tiles_.size(tile);
  const std::uint32_t top = tiles_.first_row(tile);
  const std::uint32_t left = tiles_.first_column(tile);
  for (std::uint32_t row = 0; row < rows; ++row) {
    std::uint32_t column = 0;
    const auto clear_to = [&](std::uint32_t end) {
      for (; column < end; ++column) {
        for (std::size_t b = 0; b < options_.products.size(); ++b) {
          band_of(bands, b)[std::size_t{row} * kRasterTile + column] = options_.nodata;
        }
      }
    };
    for (const auto& [begin, end] : outline_->row(top + row)) {
      clear_to(std::clamp(begin, left, left + columns) - left);
      column = std::max(column, std::clamp(end, left, left + columns) - left);
    }
    clear_to(columns);
  }
}

/// Pixels without points get the height of the triangle at their centre.
void DemOutput::fill_voids(std::uint64_t tile, Slot& slot) const {
  const TileLayout::Size size = tiles_.size(tile);
  const std::uint32_t top = tiles_.first_row(tile);
  const std::uint32_t left = tiles_.first_column(tile);
  const std::span<const float> heights = band_of(slot.layers, heights_);
  slot.filled = 0;
  bool is_first = true;
  for (std::size_t b = 0; b < options_.products.size(); ++b) {
    if (!traits_of(options_.products[b]).fills_voids) continue;
    const std::span<float> band = band_of(slot.bands, b);
    for (std::uint32_t row = 0; row < size.rows; ++row) {
      const std::size_t first = std::size_t{row} * kRasterTile;
      for (std::size_t i = first; i < first + size.columns; ++i) {
        if (!std::isnan(band[i]) || std::isnan(heights[i])) continue;
        band[i] = heights[i];
        const bool is_seen = outline_ == nullptr ||
                             outline_->has(top + row, left + static_cast<std::uint32_t>(i - first));
        if (is_first && is_seen) ++slot.filled;
      }
    }
    is_first = false;
  }
}

/// Products of neighbours.
void DemOutput::derive(std::uint64_t tile, Slot& slot) const {
  const auto [rows, columns] = tiles_.size(tile);
  const PixelGrid& grid = tiles_.whole;
  const std::uint32_t first_row = tiles_.first_row(tile);
  const std::uint32_t first_column = tiles_.first_column(tile);
  for (std::uint32_t row = 0; row < rows; ++row) {
    const Point<2> lengths = lengths_at(options_.ground, grid.centre_y(first_row + row));
    const Point<2> sides = {lengths[0] * grid.resolution, lengths[1] * grid.resolution};
    const float* north = &slot.framed[row * kFramedSide];
    RasterEnd end{.north = first_row + row == 0, .south = first_row + row + 1 == grid.rows};
    for (std::uint32_t column = 0; column < columns; ++column, ++north) {
      const float* const middle = north + kFramedSide;
      const float* const south = middle + kFramedSide;
      Neighbourhood z = {north[0],  north[1], north[2], middle[0], middle[1],
                         middle[2], south[0], south[1], south[2]};
      bool whole = is_complete(z);
      if (!whole && options_.compute_edges && std::isfinite(z[4])) {
        end.west = first_column + column == 0;
        end.east = first_column + column + 1 == grid.columns;
        complete(z, end);
        whole = is_complete(z);
      }
      Gradient gradient{};
      if (whole) {
        gradient = gradient_of(z, options_.gradient, sides);
        for (double& part : gradient) part *= options_.ground.height;
      }
      for (const auto& [product, band] : derived_) {
        slot.bands[band * RasterStore::kTilePixels + std::size_t{row} * kRasterTile + column] =
            whole ? static_cast<float>(value_of(product, z, sides, gradient)) : kNothing;
      }
    }
  }
}

double DemOutput::value_of(DemProduct product, const Neighbourhood& z, const Point<2>& sides,
                           const Gradient& gradient) const {
  switch (product) {
    case DemProduct::kSlope:
      return slope_of(gradient);
    case DemProduct::kAspect:
      return rounded_aspect_of(gradient);
    case DemProduct::kHillshade:
      return shade_of(gradient, light_direction_);
    case DemProduct::kMultiHillshade:
      return multi_shade_.of(gradient);
    case DemProduct::kRoughness:
      return roughness_of(z);
    case DemProduct::kTri:
      return ruggedness_of(z);
    case DemProduct::kTpi:
      return position_of(z);
    case DemProduct::kCurvature:
      return CurvedSurface(z, sides, options_.ground.height).curvature();
    case DemProduct::kProfileCurvature:
      return CurvedSurface(z, sides, options_.ground.height).profile();
    case DemProduct::kPlanCurvature:
      return CurvedSurface(z, sides, options_.ground.height).plan();
    default:
      return kNothing;  // painted
  }
}

/// Makes of values what is written.
void DemOutput::finish_band(DemProduct product, TileLayout::Size size,
                            std::span<float> band) const {
  const NodataNeighbourhood nodata(options_.nodata);
  const bool counts = product == DemProduct::kDensity || product == DemProduct::kCount;
  for (std::size_t i = 0; i < band.size(); ++i) {
    float& pixel = band[i];
    if (counts && std::isnan(pixel)) pixel = 0;
    const bool is_in = i / kRasterTile < size.rows && i % kRasterTile < size.columns;
    if (!is_in || !std::isfinite(pixel)) {
      pixel = options_.nodata;
      continue;
    }
    if (pixel >= nodata.lowest && pixel <= nodata.highest) pixel = nodata.replacement;
    pixel += 0.0F;  // -0 becomes 0
  }
}

}  // namespace spillway::stream
