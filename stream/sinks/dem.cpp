#include "stream/sinks/dem.h"

#include <spillway/dem.h>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <mutex>
#include <utility>

#include "formats/state/state_reader.h"
#include "formats/state/state_writer.h"
#include "src/error.h"
#include "src/geometry/longest_edge.h"
#include "src/parallel/parallel.h"
#include "src/runtime/memory_budget.h"

namespace spillway::stream {
namespace {

static_assert(RasterStore::kSide == kRasterTile, "tiles are written as they are kept");
static_assert(PixelPoints::kTilePixels == RasterStore::kTilePixels, "of the same tiles");

/// Triangles and vertices that one task takes.
constexpr std::size_t kTrianglesAtATime = 4096;
constexpr std::size_t kVerticesAtATime = 1 << 16;

/// Triangles that reach over more tiles are painted tile by tile.
constexpr std::uint64_t kTilesOfASmallTriangle = 4;

/// What GDAL and the store note of a tile of one band.
constexpr std::uint64_t kIndexBytes = 64;

PixelRule rule_of(DemProduct product) {
  switch (product) {
    case DemProduct::kHeight:
      return PixelRule::kEqual;
    case DemProduct::kDensity:
      return PixelRule::kSum;
    default:
      return PixelRule::kPreferred;
  }
}

/// Tiles that have pixels of a window; 0 if it is empty.
std::uint64_t tiles_in(const PixelWindow& window) {
  if (window.empty()) return 0;
  const auto tiles = [](std::uint32_t begin, std::uint32_t end) {
    return std::uint64_t{(end - 1) / kRasterTile} - begin / kRasterTile + 1;
  };
  return tiles(window.row_begin, window.row_end) * tiles(window.column_begin, window.column_end);
}

struct Steps {
  std::uint32_t begin;
  std::uint32_t end;
};

/// Cuts rows or columns of centres where tiles end; the first `margin` of all are in none.
std::vector<Steps> tile_steps(std::uint32_t begin, std::uint32_t end, std::uint32_t margin) {
  std::vector<Steps> steps;
  while (begin < end) {
    const std::uint32_t tile = begin < margin ? 0 : (begin - margin) / kRasterTile;
    steps.push_back({begin, std::min(end, (tile + 1) * kRasterTile + margin)});
    begin = steps.back().end;
  }
  return steps;
}

/// Decided, but nothing: it must be told from what is still undecided.
constexpr float kUndefined = std::numeric_limits<float>::infinity();

/// What is the same all over a triangle; nothing for what is not.
float value_of(DemProduct product, const Gradient& gradient, const Point<3>& light) {
  double value = std::numeric_limits<double>::quiet_NaN();
  if (product == DemProduct::kFacetSlope) value = slope_of(gradient);
  if (product == DemProduct::kFacetAspect) value = aspect_of(gradient);
  if (product == DemProduct::kFacetHillshade) value = hillshade_of(gradient, light);
  return std::isnan(value) ? kUndefined : static_cast<float>(value);
}

}  // namespace

/// What one task needs while it paints.
struct Dem::Work {
  Work(RasterStore& store, std::size_t layers) : hand(store), values(layers) {}
  RasterStore::Hand hand;
  std::vector<PixelRun> runs;
  std::vector<float> values;  ///< of the triangle, by layer; those that vary in it unused
};

Dem::Dem(DemSinkOptions options, const std::optional<IntegerLattice>& lattice,
         ScratchFolder& scratch)
    : options_(std::move(options)),
      layers_(layers_of(options_.products, options_.fill_voids)),
      lattice_(lattice),
      on_lattice_(lattice && lattice->scale[0] > 0 && lattice->scale[1] > 0),
      of_points_(are_of_points(options_.products)),
      light_direction_(direction_of(options_.light)),
      scratch_(scratch) {
  std::uint64_t least = RasterStore::least_memory(layers_.size(), options_.threads);
  if (of_points_) least = 2 * std::max(least, PixelPoints::kLeastMemory);
  if (options_.memory < least) {
    throw TooSmallLimit(
        fmt::format("the memory limit is too small: {} of it are for pixels, and {} threads "
                    "with {} products to paint need {}",
                    memory_size_text(options_.memory), options_.threads, layers_.size(),
                    memory_size_text(least)),
        {.remedy = Remedy::kMemory});
  }
}

Box<2> Dem::in_output(const Box<2>& extent) const {
  Box<2> box;
  for (const Point<2>& corner : {extent.lo, extent.hi}) {
    box.expand(lattice_
                   ? Point<2>{lattice_->to_world(0, corner[0]), lattice_->to_world(1, corner[1])}
                   : corner);
  }
  return box;
}

void Dem::begin(const Box<2>& extent) { begin(choose_grid(options_.grid, in_output(extent))); }

void Dem::begin(const PixelGrid& grid) {
  const std::vector<SheetPlace> places =
      options_.sheets ? options_.sheets(grid)
                      : std::vector<SheetPlace>{{{0, grid.rows, 0, grid.columns}}};
  sheets_ = RasterSheets(grid, places, has_neighbours(options_.products));
  const std::uint64_t bands = std::max(options_.products.size(), layers_.size());
  std::uint64_t output = 0;
  for (std::size_t s = 0; s < sheets_.size(); ++s) {
    output = std::max(output, DemOutput::bytes(sheets_[s]));
  }
  const std::uint64_t index = PixelCentres::bytes(grid) +
                              sheets_.stored_tiles() * kIndexBytes * bands + output +
                              sheets_.bytes();
  if (index > options_.memory / 2) {
    throw TooSmallLimit(fmt::format("a raster of {} x {} pixels needs {} for its index alone",
                                    grid.columns, grid.rows, memory_size_text(index)),
                        {.remedy = Remedy::kRasterMemory});
  }
  centres_.emplace(grid, on_lattice_ ? lattice_ : std::nullopt, sheets_.margin());
  std::vector<PixelRule> rules;
  for (const DemProduct product : layers_) rules.push_back(rule_of(product));
  RasterStore::PixelsOfTile wanted;
  if (closes_tiles()) {
    wanted = [this](std::uint64_t number) {
      return sheets_[sheets_.sheet_of_stored(number)].pixels_of_stored(number);
    };
  }
  RasterStore::TileClosed closed;
  std::uint64_t in_work = 0;
  if (writes_early()) {
    closed = [this](std::uint64_t number) { note_closed(number); };
    in_work = DemOutput::kLeastSlots * DemOutput::slot_bytes(options_, layers_) +
              options_.memory_of_files;
  }
  left_out_ = 0;
  points_in_pixels_ = pixels_with_points_ = filled_pixels_ = 0;
  states_ = std::vector<SheetState>(sheets_.size());
  final_.clear();
  const std::uint64_t taken = std::min(options_.memory / 2, index + in_work);
  const std::uint64_t for_points = point_memory(taken);
  store_.emplace(std::move(rules), options_.memory - taken - for_points, scratch_,
                 std::move(wanted), std::move(closed));
  cells_.emplace(grid, on_lattice_ ? lattice_ : std::nullopt);
  if (of_points_) points_.emplace(for_points, scratch_);
}

void Dem::note_closed(std::uint64_t stored_tile) {
  const std::size_t sheet = sheets_.sheet_of_stored(stored_tile);
  if (++states_[sheet].closed < sheets_[sheet].stored_count()) return;
  const std::lock_guard lock(final_mutex_);
  final_.push_back(sheet);
}

/// Unless another thread is at it.
void Dem::hand_on_final_sheets() {
  std::unique_lock lock(final_mutex_);
  if (is_handing_on_) return;
  is_handing_on_ = true;
  try {
    while (!final_.empty()) {
      const std::size_t sheet = final_.front();
      final_.pop_front();
      lock.unlock();
      options_.sheet_is_final(sheet);
      lock.lock();
    }
  } catch (...) {
    if (!lock) lock.lock();
    is_handing_on_ = false;
    throw;
  }
  is_handing_on_ = false;
}

/// Of what an index of pixels leaves: half of it beside pixels that are painted, else all.
std::uint64_t Dem::point_memory(std::uint64_t index) const {
  if (!of_points_) return 0;
  const std::uint64_t left = options_.memory - index;
  return layers_.empty() ? left : left / 2;
}

/// Heights rise with the lattice's integers.
bool Dem::heights_on_lattice() const { return lattice_ && lattice_->scale[2] > 0; }

/// Points of a pixel may come after all triangles at its centre. Triangles that are mapped to
/// output coordinates may overlap by roundings.
bool Dem::closes_tiles() const {
  return options_.closes_tiles && !of_points_ && (on_lattice_ || !lattice_) &&
         std::ranges::find(layers_, DemProduct::kDensity) == layers_.end();
}

PlacedPoint Dem::placed(const LatticePoint& vertex) const {
  if (!on_lattice_) return PlacedPoint(in_world(lattice_, vertex).numbers());
  return {vertex[0], vertex[1], lattice_->to_world(2, vertex[2])};
}

std::vector<PlacedPoint> Dem::placed(std::span<const LatticePoint> vertices) const {
  std::vector<PlacedPoint> result;
  result.reserve(vertices.size());
  for (const LatticePoint& vertex : vertices) result.push_back(placed(vertex));
  return result;
}

void Dem::paint(std::span<const PlacedPoint> vertices, std::span<const std::uint32_t> corners) {
  struct Large {
    Triangle canonical;
    PixelWindow window;
  };
  std::vector<CentreWindow> windows(vertices.size());
  std::mutex mutex;
  std::vector<Large> large;  // guarded by mutex
  const auto find_windows = [&](std::size_t /*grain*/, std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v) windows[v] = centres_around(*centres_, vertices[v]);
  };
  const auto paint_some = [&](std::size_t /*grain*/, std::size_t begin, std::size_t end) {
    Work work(*store_, layers_.size());
    for (std::size_t t = begin; t < end; ++t) {
      const std::uint32_t* const v = &corners[3 * t];
      const PixelWindow window = window_of(windows[v[0]], windows[v[1]], windows[v[2]]);
      if (window.empty() && !options_.max_edge) continue;
      const Triangle canonical =
          in_canonical_order({vertices[v[0]], vertices[v[1]], vertices[v[2]]});
      if (options_.max_edge && has_longer_edge<2>(in_output(canonical), *options_.max_edge)) {
        ++left_out_;
        continue;
      }
      if (options_.outline && !window.empty()) options_.outline(in_output(canonical));
      if (tiles_in(window) > kTilesOfASmallTriangle) {
        const std::lock_guard lock(mutex);
        large.push_back({canonical, window});
      } else {
        paint_pixels(canonical, window, work);
      }
    }
  };
  // Isolated: the caller may hold what another of its tasks would wait for.
  isolated([&] {
    parallel_for(vertices.size(), kVerticesAtATime, find_windows);
    parallel_for(corners.size() / 3, kTrianglesAtATime, paint_some);
    for (const auto& [canonical, window] : large) paint_large(canonical, window);
    if (writes_early()) hand_on_final_sheets();
  });
}

Triangle Dem::in_output(const Triangle& placed) const {
  Triangle triangle = placed;
  if (on_lattice_) {
    for (Point<3>& p : triangle)
      p = {lattice_->to_world(0, p[0]), lattice_->to_world(1, p[1]), p[2]};
  }
  return triangle;
}

/// Paints a triangle of many tiles: each tile is held once, and many threads work on it.
void Dem::paint_large(const Triangle& canonical, const PixelWindow& whole) {
  const std::vector<Steps> down = tile_steps(whole.row_begin, whole.row_end, sheets_.margin());
  const std::vector<Steps> across =
      tile_steps(whole.column_begin, whole.column_end, sheets_.margin());
  parallel_for(
      across.size() * down.size(), 1,
      [&](std::size_t /*grain*/, std::size_t begin, std::size_t end) {
        Work work(*store_, layers_.size());
        for (std::size_t t = begin; t < end; ++t) {
          const Steps& rows = down[t / across.size()];
          const Steps& columns = across[t % across.size()];
          paint_pixels(canonical, {rows.begin, rows.end, columns.begin, columns.end}, work);
        }
      });
}

void Dem::paint_pixels(const Triangle& canonical, const PixelWindow& window, Work& work) {
  find_pixels(*centres_, canonical, window, work.runs);
  if (work.runs.empty()) return;
  const Point<2> scale =
      on_lattice_ ? Point<2>{lattice_->scale[0], lattice_->scale[1]} : Point<2>{1, 1};
  const TrianglePlane plane(canonical, scale);
  const Gradient gradient = on_ground(plane, canonical);
  for (std::size_t b = 0; b < work.values.size(); ++b) {
    work.values[b] = value_of(layers_[b], gradient, light_direction_);
  }
  for (const PixelRun& run : work.runs) paint_run(run, plane, work);
}

/// A degree has the length that it has at the first corner, so that it is the same in all pixels of
/// the triangle and in all rasters.
Gradient Dem::on_ground(const TrianglePlane& plane, const Triangle& canonical) const {
  const Gradient gradient = plane.gradient();
  const GroundScale& ground = options_.ground;
  if (ground.changes_nothing()) return gradient;
  const double y = canonical[0][1];
  const Point<2> lengths = lengths_at(ground, on_lattice_ ? lattice_->to_world(1, y) : y);
  return {gradient[0] * ground.height / lengths[0], gradient[1] * ground.height / lengths[1]};
}

/// Heights just beyond a sheet's edges; what remains of the run is within.
void Dem::paint_ring(const TileLayout& tiles, PixelRun& run, const TrianglePlane& plane,
                     Work& work) {
  const auto heights = std::ranges::find(layers_, DemProduct::kHeight) - layers_.begin();
  const double y = centres_->y()[tiles.window.row_begin + run.row];
  const auto paint_one = [&](std::uint32_t column) {
    const std::uint64_t pixel = tiles.ring_pixel(run.row, column);
    float* const tile = work.hand.tile(tiles.first + pixel / RasterStore::kTilePixels);
    if (tile == nullptr) return;
    if (run.owned) work.hand.decide(1);
    set_pixel(tile[static_cast<std::size_t>(heights) * RasterStore::kTilePixels +
                   pixel % RasterStore::kTilePixels],
              static_cast<float>(
                  plane.at(run.relation, centres_->x()[tiles.window.column_begin + column], y)));
  };
  if (run.row == 0 || run.row > tiles.rows) {
    for (; run.begin < run.end; ++run.begin) paint_one(run.begin);
    return;
  }
  if (run.begin == 0) paint_one(run.begin++);
  if (run.end > tiles.columns + 1 && run.begin < run.end) paint_one(--run.end);
}

void Dem::paint_run(const PixelRun& run, const TrianglePlane& plane, Work& work) {
  sheets_.visit(run.row, run.begin, run.end,
                [&](std::size_t sheet, std::uint32_t begin, std::uint32_t end) {
                  if (states_[sheet].written) return;
                  const TileLayout& tiles = sheets_[sheet];
                  PixelRun part = run;
                  part.row -= tiles.window.row_begin;
                  part.begin = begin - tiles.window.column_begin;
                  part.end = end - tiles.window.column_begin;
                  paint_sheet(tiles, part, plane, work);
                });
}

/// Rows and columns of the run are those of the sheet, which begin with its ring.
void Dem::paint_sheet(const TileLayout& tiles, PixelRun run, const TrianglePlane& plane,
                      Work& work) {
  if (tiles.margin > 0) paint_ring(tiles, run, plane, work);
  const double y = centres_->y()[tiles.window.row_begin + run.row];
  const std::span<const double> x = centres_->x().subspan(tiles.window.column_begin);
  const std::uint32_t row = run.row - tiles.margin;
  for (std::uint32_t begin = run.begin; begin < run.end;) {
    const std::uint32_t column = begin - tiles.margin;
    const std::uint32_t end =
        std::min(run.end, (column / kRasterTile + 1) * kRasterTile + tiles.margin);
    float* pixels = work.hand.tile(tiles.stored(tiles.number(row, column)));
    if (pixels == nullptr) {
      begin = end;
      continue;
    }
    pixels += row % kRasterTile * kRasterTile + column % kRasterTile;
    if (run.owned) work.hand.decide(end - begin);
    for (std::size_t b = 0; b < layers_.size(); ++b) {
      const DemProduct product = layers_[b];
      if (product == DemProduct::kHeight && run.relation == TriangleRelation::kInside) {
        for (std::uint32_t c = begin; c < end; ++c) {
          set_pixel(pixels[c - begin], static_cast<float>(plane.inside(x[c], y)));
        }
      } else if (product == DemProduct::kHeight) {
        for (std::uint32_t c = begin; c < end; ++c) {
          set_pixel(pixels[c - begin], static_cast<float>(plane.at(run.relation, x[c], y)));
        }
      } else if (product != DemProduct::kDensity) {
        for (std::uint32_t c = begin; c < end; ++c) {
          put_pixel(pixels[c - begin], work.values[b], PixelRule::kPreferred, run.owned);
        }
      }
      pixels += RasterStore::kTilePixels;
    }
    begin = end;
  }
}

void Dem::count(std::span<const PlacedPoint> vertices) {
  const auto found = std::ranges::find(layers_, DemProduct::kDensity);
  if (found == layers_.end()) return;
  const auto band = static_cast<std::size_t>(found - layers_.begin());
  const auto count_some = [&](std::size_t /*grain*/, std::size_t begin, std::size_t end) {
    Work work(*store_, layers_.size());
    for (const PlacedPoint& vertex : vertices.subspan(begin, end - begin)) {
      const auto column = cells_->column(vertex[0]);
      const auto row = cells_->row(vertex[1]);
      if (!column || !row) continue;
      sheets_.visit_pixel(*row, *column, [&](std::size_t sheet, std::uint32_t r, std::uint32_t c) {
        const TileLayout& tiles = sheets_[sheet];
        float* const pixels = work.hand.tile(tiles.stored(tiles.number(r, c)));
        put_pixel(pixels[band * RasterStore::kTilePixels +
                         std::size_t{r % kRasterTile} * kRasterTile + c % kRasterTile],
                  1, PixelRule::kSum, true);
      });
    }
  };
  isolated([&] { parallel_for(vertices.size(), kVerticesAtATime, count_some); });
}

void Dem::take_points(std::span<const LatticePoint> points) {
  std::vector<PointInPixel> inside;
  inside.reserve(points.size());
  for (const LatticePoint& point : points) {
    const PlacedPoint place = placed(point);
    const auto column = cells_->column(place[0]);
    const auto row = cells_->row(place[1]);
    if (!column || !row) continue;
    // No zero has a sign, which would make the order of equal heights matter.
    const double z = (heights_on_lattice() ? point[2] : place[2]) + 0.0;
    sheets_.visit_pixel(*row, *column, [&](std::size_t sheet, std::uint32_t r, std::uint32_t c) {
      const TileLayout& tiles = sheets_[sheet];
      const std::uint32_t in_tile = r % kRasterTile * kRasterTile + c % kRasterTile;
      inside.push_back({tiles.stored(tiles.number(r, c)) * PixelPoints::kTilePixels + in_tile, z});
    });
  }
  points_->add(inside);
}

std::uint64_t Dem::spilled_bytes() const {
  return store_->spilled_bytes() + (points_ ? points_->spilled_bytes() : 0);
}

RasterOptions Dem::raster_options(std::size_t sheet) const {
  RasterOptions raster;
  raster.grid.pixels = sheets_.grid_of(sheet);
  auto percent = options_.percentiles.begin();
  for (const DemProduct product : options_.products) {
    const bool is_percentile = product == DemProduct::kPercentile;
    raster.bands.push_back(name_of({product, is_percentile ? *percent++ : 0}));
    // The mean of 359 and 1 is no direction.
    if (product == DemProduct::kAspect || product == DemProduct::kFacetAspect) {
      raster.averaged_overviews = false;
    }
  }
  raster.nodata = options_.nodata;
  raster.threads = options_.threads;
  raster.memory = options_.memory;
  return raster;
}

void Dem::save(StateWriter& state) {
  state.section("dem");
  bool begun = store_.has_value();
  PixelGrid raster = grid();
  state(begun, raster, left_out_);
  if (!begun) return;
  for (SheetState& sheet : states_) {
    std::uint64_t closed = sheet.closed;
    bool written = sheet.written;
    state(closed, written, sheet.content.pixels_with_data, sheet.content.is_empty);
  }
  store_->save(state);
  if (points_) points_->save(state);
}

void Dem::restore(StateReader& state) {
  state.section("dem");
  bool begun = false;
  PixelGrid raster;
  std::uint64_t left_out = 0;
  state(begun, raster, left_out);
  if (!begun) return;
  begin(raster);
  left_out_ = left_out;
  for (std::size_t s = 0; s < states_.size(); ++s) {
    std::uint64_t closed = 0;
    bool written = false;
    state(closed, written, states_[s].content.pixels_with_data, states_[s].content.is_empty);
    states_[s].closed = closed;
    states_[s].written = written;
    if (writes_early() && !written && closed == sheets_[s].stored_count()) final_.push_back(s);
  }
  store_->restore(state);
  if (points_) points_->restore(state);
}

SheetContent Dem::write(Raster& raster, const std::function<void(std::uint64_t pixels)>& progress,
                        const OtherTiles& others, std::size_t sheet, bool while_painting) {
  SheetState& state = states_[sheet];
  state.written = true;
  // All painted, the pixels have twice their memory: the triangulation, which had more, is done.
  const std::uint64_t slots = while_painting
                                  ? DemOutput::kLeastSlots
                                  : 2 * options_.memory / DemOutput::slot_bytes(options_, layers_);
  DemOutput output(options_, layers_, sheets_[sheet], sheets_.outline(sheet), *store_,
                   std::clamp<std::size_t>(slots, DemOutput::kLeastSlots, options_.threads + 2));
  std::optional<PointBands> bands;
  if (points_) {
    bands.emplace(options_, *points_, heights_on_lattice() ? lattice_ : std::nullopt, scratch_);
    output.add_points(*bands);
  }
  state.content = output.write(raster, progress, others);
  if (bands) {
    points_in_pixels_ += bands->points();
    pixels_with_points_ += bands->pixels();
  }
  filled_pixels_ += output.filled_pixels();
  return state.content;
}

std::uint64_t Dem::pixels_with_data() const {
  std::uint64_t count = 0;
  for (const SheetState& sheet : states_) count += sheet.content.pixels_with_data;
  return count;
}

}  // namespace spillway::stream
