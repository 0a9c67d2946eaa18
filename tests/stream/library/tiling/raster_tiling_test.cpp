// How rasters are cut into files: where they lie, and what these are called.

#include "stream/library/tiling/raster_tiling.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <set>
#include <string>
#include <tuple>
#include <vector>

#include "src/error.h"
#include "stream/library/tiling/square_tiling.h"
#include "tests/formats/inputs/temporary_files.h"

namespace spillway::test {
namespace {

std::vector<std::string> names_of(const PixelGrid& raster, double side,
                                  const std::string& pattern = "d_{x}_{y}.tif") {
  std::vector<std::string> names;
  for (const RasterTile& tile : SquareTiling(pattern, side).tiles(raster)) {
    names.push_back(tile.path);
  }
  return names;
}

std::string refusal_of(const PixelGrid& raster, double side,
                       const std::string& pattern = "d_{x}_{y}.tif") {
  try {
    (void)SquareTiling(pattern, side).tiles(raster);
  } catch (const InvalidArgument& error) {
    return error.what();
  }
  return "";
}

TEST(SquareTiling, IsCalledByTheSouthWesternCorners) {
  EXPECT_EQ(names_of({1500, 4000.5, 0.5, 2000, 1001}, 1000),
            (std::vector<std::string>{"d_1000_4000.tif", "d_2000_4000.tif", "d_1000_3000.tif",
                                      "d_2000_3000.tif"}));
  EXPECT_EQ(names_of({-10, 10, 5, 4, 4}, 10),
            (std::vector<std::string>{"d_-10_0.tif", "d_0_0.tif", "d_-10_-10.tif", "d_0_-10.tif"}));
  EXPECT_EQ(names_of({0.25, 0.5, 0.25, 2, 1}, 0.5, "a/{y}-{x}.tif"),
            (std::vector<std::string>{"a/0-0.tif", "a/0-0.5.tif"}));
}

TEST(SquareTiling, CoversEachPixelOnce) {
  for (const double west : {-7.0, 0.0, 3.0, 12.0}) {
    for (const double north : {-5.0, 0.0, 4.0, 9.0}) {
      const PixelGrid raster{west * 0.1, north * 0.1, 0.1, 23, 17};
      std::vector<int> covered(std::size_t{23} * 17);
      std::set<std::string> names;
      for (const RasterTile& tile : SquareTiling("{x}_{y}.tif", 0.5).tiles(raster)) {
        EXPECT_FALSE(tile.window.empty());
        EXPECT_TRUE(names.insert(tile.path).second) << tile.path;
        for (std::uint32_t row = tile.window.row_begin; row < tile.window.row_end; ++row) {
          for (std::uint32_t c = tile.window.column_begin; c < tile.window.column_end; ++c) {
            ++covered[row * 23 + c];
          }
        }
      }
      EXPECT_EQ(covered, std::vector<int>(covered.size(), 1)) << west << ", " << north;
    }
  }
}

TEST(SquareTiling, TellsWhyARasterCannotBeCut) {
  const PixelGrid raster{0, 0, 0.5, 100, 100};
  EXPECT_EQ(refusal_of(raster, 10), "");
  EXPECT_NE(refusal_of(raster, 0.7).find("whole number of pixels"), std::string::npos);
  EXPECT_NE(refusal_of(raster, 0.2).find("whole number of pixels"), std::string::npos);
  EXPECT_NE(refusal_of({0.25, 0, 0.5, 100, 100}, 10).find("multiples"), std::string::npos);
  EXPECT_NE(refusal_of({0, 0, 1, 100'000, 100'000}, 1).find("a million"), std::string::npos);
  EXPECT_NE(refusal_of(raster, 10, "d_{x}.tif").find("{x} and {y}"), std::string::npos);
  EXPECT_NE(refusal_of(raster, 10, "{x}/{y}.tif").find("{x} and {y}"), std::string::npos);
  EXPECT_NE(refusal_of(raster, 0).find("above 0"), std::string::npos);
  EXPECT_NE(refusal_of(raster, 1e30).find("whole number of pixels"), std::string::npos);
}

TEST(SquareTiling, FindsFilesThatLookLikeOthersOfItsTiles) {
  const TemporaryFiles files;
  for (const char* name :
       {"d_0_0.tif", "d_-10_2.5.tif", "d_a_0.tif", "xd_0_0.tif", "d_1_1.tif.part"}) {
    std::ignore = files.put(name, "x");
  }
  std::ignore = files.put("a^\\1[+]_5_5.tif", "x");
  EXPECT_EQ(SquareTiling(files.path("a^\\1[+]_{x}_{y}.tif"), 10).others_than({}).size(), 1U);
  const SquareTiling tiling(files.path("d_{x}_{y}.tif"), 10);
  EXPECT_EQ(tiling.others_than({files.path("d_0_0.tif")}),
            (std::vector<std::string>{files.path("d_-10_2.5.tif")}));
}

TEST(RasterTiling, ItsVrtIsCalledAsItsFilesWithoutTheirPlaces) {
  EXPECT_EQ(vrt_path_of("out/dtm_{x}_{y}.tif"), "out/dtm.vrt");
  EXPECT_EQ(vrt_path_of("{x}_{y}.tif"), "tiles.vrt");
  EXPECT_EQ(vrt_path_of("{x}-{y}_dom.tiff"), "dom.vrt");
  EXPECT_EQ(vrt_path_of("a_{x}_{y}_b.tif"), "a_b.vrt");
  EXPECT_EQ(vrt_path_of("dtm_{sheet name}.tif"), "dtm.vrt");
}

}  // namespace
}  // namespace spillway::test
