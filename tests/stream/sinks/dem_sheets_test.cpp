// A raster that is cut into sheets: each pixel is as in the whole one, and sheets are handed on
// while triangles come.

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <map>
#include <mutex>
#include <random>
#include <set>
#include <string>
#include <vector>

#include "formats/state/state_reader.h"
#include "formats/state/state_writer.h"
#include "stream/sinks/raster_sheets.h"
#include "tests/stream/sinks/dem_runner.h"

namespace spillway::test {
namespace {

double rough(double x, double y) { return 100 + 20 * std::sin(x / 37) + 15 * std::cos(y / 23); }

bool same(float a, float b) { return a == b || (std::isnan(a) && std::isnan(b)); }

/// Windows of a grid: cut at some rows and columns.
std::vector<SheetPlace> cut(const PixelGrid& raster, std::uint32_t first, std::uint32_t side) {
  const auto cuts = [&](std::uint32_t count) {
    std::vector<std::uint32_t> ends = {0};
    for (std::uint32_t end = first; end < count; end += side) ends.push_back(end);
    ends.push_back(count);
    return ends;
  };
  std::vector<SheetPlace> places;
  const auto rows = cuts(raster.rows);
  const auto columns = cuts(raster.columns);
  for (std::size_t r = 1; r < rows.size(); ++r) {
    for (std::size_t c = 1; c < columns.size(); ++c) {
      places.push_back({{rows[r - 1], rows[r], columns[c - 1], columns[c]}});
    }
  }
  return places;
}

/// What sheets have, in the place of the whole raster; those that were handed on early among them.
struct Sheets {
  PixelGrid grid;
  std::vector<std::vector<float>> bands;
  std::vector<int> written;  ///< by pixel, how often
  std::uint64_t with_data = 0;
  std::size_t count = 0;
  std::set<std::size_t> early;
};

void put(Dem& dem, std::size_t sheet, Sheets& all) {
  const PixelGrid part = dem.sheets().grid_of(sheet);
  KeepingRaster raster(part, all.bands.size());
  all.with_data += dem.write(
                          raster, [](std::uint64_t) {}, nullptr, sheet)
                       .pixels_with_data;
  const PixelWindow& window = dem.sheets()[sheet].window;
  for (std::uint32_t row = 0; row < part.rows; ++row) {
    for (std::uint32_t column = 0; column < part.columns; ++column) {
      const std::size_t i =
          std::size_t{window.row_begin + row} * all.grid.columns + window.column_begin + column;
      ++all.written[i];
      for (std::size_t b = 0; b < all.bands.size(); ++b) {
        all.bands[b][i] = raster.bands[b][row * part.columns + column];
      }
    }
  }
}

Sheets sheets_of(const std::vector<Point<3>>& points, DemSinkOptions options,
                 EngineOptions stream) {
  if (options.memory == 0) options.memory = kMemory;
  options.threads = stream.threads;
  const std::string path = write_points<3>(points);
  JoinedInputs source(disk(), {path}, {.dimension = 2});
  QuietSetup setup(std::move(stream), kMemory);
  Sheets all;
  std::optional<Dem> dem;
  options.sheet_is_final = [&](std::size_t sheet) {
    EXPECT_TRUE(all.early.insert(sheet).second) << "once only";
    put(*dem, sheet, all);
  };
  dem.emplace(options, source.lattice(), *setup.scratch);
  class Extents final : public RunSink {
   public:
    Extents(Dem& dem, Sheets& all) : dem_(dem), all_(all) {}
    void extent_known(const Box<2>& extent, std::uint64_t /*points*/) override {
      dem_.begin(extent);
      all_.grid = dem_.grid();
      const std::size_t pixels = std::size_t{all_.grid.columns} * all_.grid.rows;
      all_.bands.assign(dem_.raster_options().bands.size(), std::vector<float>(pixels));
      all_.written.resize(pixels);
    }

   private:
    Dem& dem_;
    Sheets& all_;
  } extents(*dem, all);
  DemWriter writer(*dem);
  (void)triangulate_stream<2>(
      source, writer, {setup.options, *setup.scratch, setup.budget, extents, setup.progress});
  all.count = dem->sheets().size();
  for (std::size_t s = 0; s < all.count; ++s) {
    if (!dem->is_written(s)) put(*dem, s, all);
  }
  EXPECT_EQ(dem->pixels_with_data(), all.with_data);
  return all;
}

const DemSinkOptions kMany{
    .products = {DemProduct::kHeight, DemProduct::kSlope, DemProduct::kFacetSlope,
                 DemProduct::kHillshade, DemProduct::kTpi, DemProduct::kPlanCurvature},
    .nodata = std::numeric_limits<float>::quiet_NaN()};

std::vector<Point<3>> some_points(bool whole) {
  return with_heights(square_points(20'000, 700, whole, 5),
                      [](double x, double y) { return x < 300 ? 1 : rough(x, y); });
}

TEST(DemSheets, EqualTheWholeRasterInEveryPixel) {
  for (const bool whole : {false, true}) {
    const auto points = some_points(whole);
    for (const bool edges : {false, true}) {
      DemSinkOptions options = kMany;
      options.compute_edges = edges;
      options.grid = {.resolution = 1};
      const Rastered one = raster_of(points, options);
      options.closes_tiles = true;
      for (const std::uint32_t side : {100U, 256U, 300U, 1000U}) {
        options.sheets = [side](const PixelGrid& grid) { return cut(grid, side / 3, side); };
        for (const unsigned threads : {1U, 2U, 4U}) {
          EngineOptions stream{.asked = {.tile_points = 1000}};
          stream.threads = threads;
          options.memory = threads == 2 ? kMemory
                                        : 2 * RasterStore::least_memory(3, threads) +
                                              2 * DemOutput::slot_bytes(
                                                      options, layers_of(options.products, false));
          const Sheets sheets = sheets_of(points, options, stream);
          ASSERT_EQ(sheets.grid, one.grid);
          EXPECT_EQ(sheets.with_data, one.with_data);
          EXPECT_EQ(sheets.written, std::vector<int>(sheets.written.size(), 1));
          if (side == 100) {
            EXPECT_GT(sheets.early.size(), sheets.count / 2);
          }
          for (std::size_t b = 0; b < one.bands.size(); ++b) {
            for (std::size_t i = 0; i < one.bands[b].size(); ++i) {
              ASSERT_TRUE(same(sheets.bands[b][i], one.bands[b][i]))
                  << "side " << side << ", band " << b << ", pixel " << i % one.grid.columns << ", "
                  << i / one.grid.columns;
            }
          }
        }
      }
    }
  }
}

TEST(DemSheets, AreNotHandedOnWhileDensitiesOrGapsLeaveThemOpen) {
  const auto points = some_points(false);
  DemSinkOptions options{.products = {DemProduct::kHeight, DemProduct::kDensity},
                         .closes_tiles = true};
  options.sheets = [](const PixelGrid& grid) { return cut(grid, 50, 200); };
  EXPECT_EQ(sheets_of(points, options, {}).early.size(), 0U);
  options.products = {DemProduct::kHeight};
  const Sheets sheets = sheets_of(points, options, {});
  EXPECT_GT(sheets.early.size(), 0U);
  EXPECT_LT(sheets.early.size(), sheets.count)
      << "at the raster's edges lie pixels beyond the hull";
}

/// Some overlap, some lie apart, one has its outline cut out.
TEST(DemSheets, MayLieAnywhereAndHaveOutlines) {
  const auto points = some_points(false);
  DemSinkOptions options = kMany;
  const Rastered one = raster_of(points, options);
  options.closes_tiles = true;
  const std::vector<std::vector<Point<2>>> triangle = {{{200, 100}, {600, 130}, {350, 620}}};
  std::shared_ptr<const PolygonPixels> outline;
  options.sheets = [&](const PixelGrid& grid) {
    outline = std::make_shared<PolygonPixels>(triangle, grid);
    return std::vector<SheetPlace>{{{10, 300, 20, 400}},
                                   {{100, 200, 350, 640}},
                                   {{299, 301, 0, 1}},
                                   {outline->window(), outline},
                                   {{0, 300, 20, 21}}};
  };
  const auto scratch = make_scratch_folder(::testing::TempDir(), std::nullopt);
  for (const unsigned threads : {1U, 3U}) {
    EngineOptions stream{.asked = {.tile_points = 1000}};
    stream.threads = threads;
    options.memory = kMemory;
    options.threads = threads;
    const std::string path = write_points<3>(points);
    JoinedInputs source(disk(), {path}, {.dimension = 2});
    QuietSetup setup(std::move(stream), kMemory);
    Dem dem(options, source.lattice(), *setup.scratch);
    dem.begin(one.grid);
    RunSink nothing;
    DemWriter writer(dem);
    (void)triangulate_stream<2>(
        source, writer, {setup.options, *setup.scratch, setup.budget, nothing, setup.progress});
    std::size_t inside = 0;
    for (std::size_t s = 0; s < dem.sheets().size(); ++s) {
      const PixelWindow& window = dem.sheets()[s].window;
      KeepingRaster raster(dem.sheets().grid_of(s), options.products.size());
      dem.write(
          raster, [](std::uint64_t) {}, nullptr, s);
      for (std::uint32_t row = window.row_begin; row < window.row_end; ++row) {
        for (std::uint32_t column = window.column_begin; column < window.column_end; ++column) {
          bool is_in = s != 3;
          if (s == 3) {
            for (const auto& [begin, end] : outline->row(row)) {
              is_in = is_in || (column >= begin && column < end);
            }
          }
          inside += is_in && s == 3 ? 1 : 0;
          const std::size_t i =
              std::size_t{row - window.row_begin} * (window.column_end - window.column_begin) +
              column - window.column_begin;
          for (std::size_t b = 0; b < options.products.size(); ++b) {
            const float expected =
                is_in ? one.bands[b][row * one.grid.columns + column] : options.nodata;
            ASSERT_TRUE(same(raster.bands[b][i], expected)) << s << ": " << row << ", " << column;
          }
        }
      }
    }
    EXPECT_GT(inside, 50'000U);
  }
}

TEST(RasterSheets, AreFoundByTheirRowsAndColumns) {
  std::mt19937 random(3);
  const PixelGrid grid{0, 60, 1, 50, 60};
  for (int run = 0; run < 200; ++run) {
    const bool with_ring = run % 2 == 1;
    const std::uint32_t margin = with_ring ? 1 : 0;
    std::vector<SheetPlace> places(1 + random() % 6);
    for (auto& [window, outline] : places) {
      const std::uint32_t row = random() % 60;
      const std::uint32_t column = random() % 50;
      window = {row, row + 1 + static_cast<std::uint32_t>(random()) % (60 - row), column,
                column + 1 + static_cast<std::uint32_t>(random()) % (50 - column)};
    }
    const RasterSheets sheets(grid, places, with_ring);
    for (std::uint32_t row = 0; row < grid.rows + 2 * margin; ++row) {
      const std::uint32_t begin = random() % 50;
      const std::uint32_t end = begin + 1 + random() % 10;
      std::multiset<std::array<std::size_t, 3>> found;
      sheets.visit(row, begin, end, [&](std::size_t sheet, std::uint32_t b, std::uint32_t e) {
        found.insert({sheet, b, e});
      });
      std::multiset<std::array<std::size_t, 3>> expected;
      for (std::size_t s = 0; s < places.size(); ++s) {
        const PixelWindow& w = places[s].window;
        const std::uint32_t b = std::max(begin, w.column_begin);
        const std::uint32_t e = std::min(end, w.column_end + 2 * margin);
        if (row >= w.row_begin && row < w.row_end + 2 * margin && b < e) expected.insert({s, b, e});
      }
      ASSERT_EQ(found, expected) << run << ", row " << row;
    }
    std::uint64_t number = 0;
    for (std::size_t s = 0; s < sheets.size(); ++s) {
      for (std::uint64_t i = 0; i < sheets[s].stored_count(); ++i, ++number) {
        ASSERT_EQ(sheets.sheet_of_stored(number), s);
      }
    }
    ASSERT_EQ(number, sheets.stored_tiles());
  }
}

}  // namespace
}  // namespace spillway::test
