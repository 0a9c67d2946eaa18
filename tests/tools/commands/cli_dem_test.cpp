// `dem`: rasters as GDAL sees them, all ways to the same bytes, and what is refused.

#include <fmt/format.h>
#include <gdal_priv.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <ogr_spatialref.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <random>
#include <string>
#include <vector>

#include "tests/tools/command_runner.h"
#include "tests/tools/commands/opened_raster.h"

namespace spillway::test {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;

/// x, y and z of a quadratic surface on a grid of `side` x `side` points, `step` apart.
std::string surface(int side, double step) {
  std::string text;
  for (int i = 0; i < side * side; ++i) {
    const double x = i % side * step;
    const double y = i / side * step + 0.1 * (i % 3);
    text += fmt::format("{} {} {}\n", x, y, 0.1 * x * x - 0.2 * y);
  }
  return text;
}

TEST(Dem, FileIsATiledCompressedGeoTiffWithNodata) {
  const Workspace work;
  work.write("points.txt", surface(40, 1));
  work.succeed("spillway dem -q points.txt -o dem.tif --resolution 0.5");
  EXPECT_THAT(work.names(), ElementsAre("dem.tif", "points.txt"));
  const OpenedRaster dem(work, "dem.tif");
  EXPECT_EQ(dem.structure("COMPRESSION"), "DEFLATE");
  int width = 0;
  int height = 0;
  dem.band().GetBlockSize(&width, &height);
  EXPECT_EQ(width, 256);
  EXPECT_EQ(height, 256);
  EXPECT_EQ(dem.band().GetNoDataValue(), -9999);
  EXPECT_STREQ(dem.band().GetDescription(), "height");
  EXPECT_EQ(dem.columns(), 78);
  EXPECT_EQ(dem.transform, (std::array{0.0, 0.5, 0.0, 39.2, 0.0, -0.5}));
}

TEST(Dem, HeightsAreTheSurfacesWithinTheInterpolationBound) {
  const Workspace work;
  work.write("points.txt", surface(60, 0.5));
  work.succeed("spillway dem -q points.txt -o dem.tif --resolution 0.25 --bounds 1,1,28,28");
  const OpenedRaster dem(work, "dem.tif");
  const std::vector<float> pixels = dem.pixels();
  ASSERT_EQ(pixels.size(), 108U * 108);
  for (int i = 0; i < 108 * 108; ++i) {
    const double x = 1 + (i % 108 + 0.5) * 0.25;
    const double y = 28 - (i / 108 + 0.5) * 0.25;
    // A second derivative of 0.2 over triangles within a circle of radius 0.5.
    EXPECT_NEAR(pixels[i], 0.1 * x * x - 0.2 * y, 0.2 * 0.25 / 2 + 1e-5);
  }
}

TEST(Dem, TilesWithoutTrianglesAreEmptyWhateverTheCompression) {
  const Workspace work;
  work.write("triangle.txt", "0 0 1\n700 0 1\n0 700 1\n");
  std::vector<float> right;
  for (const std::string options : {"--compress none", "--compress deflate", "--compress zstd",
                                    "--cog --compress none", "--cog", "--threads 1"}) {
    work.succeed("spillway dem -q triangle.txt -o dem.tif --resolution 1 " + options);
    const std::vector<float> pixels = OpenedRaster(work, "dem.tif").pixels();
    if (right.empty()) right = pixels;
    EXPECT_EQ(pixels, right) << options;
    EXPECT_EQ(pixels[699], -9999) << options;
  }
}

TEST(Dem, EqualsWhatGdalGridInterpolates) {
  const Workspace work;
  work.succeed("command -v gdal_grid > gdal_grid.path || true");
  if (work.read("gdal_grid.path").empty()) GTEST_SKIP() << "gdal_grid is not installed";
  work.succeed(
      "spillway generate -q uniform -n 2000 --dim 3 --seed 5 -o points.csv\n"
      "spillway dem -q points.csv -o dem.tif --resolution 0.01 --bounds 0.1,0.1,0.9,0.9\n"
      "{ echo x,y,z; grep -v '[a-z#]' points.csv | tr ' ' ','; } > table.csv\n"
      "cat > table.vrt <<end\n"
      "<OGRVRTDataSource><OGRVRTLayer name='table'><SrcDataSource>table.csv</SrcDataSource>\n"
      "<GeometryType>wkbPoint</GeometryType>\n"
      "<GeometryField encoding='PointFromColumns' x='x' y='y' z='z'/>\n"
      "</OGRVRTLayer></OGRVRTDataSource>\n"
      "end\n"
      "gdal_grid -q -a linear:radius=0:nodata=-9999 -txe 0.1 0.9 -tye 0.9 0.1 -outsize 80 80 "
      "-ot Float32 -l table table.vrt grid.tif");
  const std::vector<float> ours = OpenedRaster(work, "dem.tif").pixels();
  const OpenedRaster grid(work, "grid.tif");
  EXPECT_LT(grid.transform[5], 0);
  const std::vector<float> theirs = grid.pixels();
  ASSERT_EQ(ours.size(), theirs.size());
  // GDAL locates points by rounded barycentric coordinates and misses a few near edges.
  std::size_t missed = 0;
  for (std::size_t i = 0; i < ours.size(); ++i) {
    if (theirs[i] == -9999) {
      ++missed;
    } else {
      EXPECT_NEAR(ours[i], theirs[i], 1e-5) << i;
    }
  }
  EXPECT_LT(missed, 10U);
}

TEST(Dem, ThreadsTilesAndWaysThroughMeshesGiveTheSameBytes) {
  const Workspace work;
  const std::string products =
      "--resolution 0.7 --product height,slope,facet-slope,facet-aspect,facet-hillshade,density";
  work.succeed(
      "spillway generate -q terrain -n 50000 -o in.las\n"
      "spillway triangulate -q in.las -o tin.spm\n"
      "spillway triangulate -q in.las -o tin.ply\n"
      "spillway dem -q in.las -o one.tif --threads 1 " +
      products +
      "\n"
      "spillway dem -q in.las -o two.tif --threads 2 " +
      products +
      "\n"
      "spillway dem -q in.las -o tiles.tif --threads 2 --tile-points 2000 --leaf-points 300 " +
      products + "\nspillway dem -q - -o pipe.tif < in.las " + products +
      "\n"
      "spillway dem -q tin.spm -o spm.tif " +
      products +
      "\n"
      "spillway triangulate -q in.las -o - | spillway dem -q - -o chain.tif " +
      products +
      "\n"
      "spillway dem -q tin.ply -o ply.tif " +
      products);
  const std::string bytes = work.read("one.tif");
  EXPECT_GT(bytes.size(), 10'000U);
  for (const char* name : {"two.tif", "tiles.tif", "pipe.tif", "spm.tif", "chain.tif", "ply.tif"}) {
    EXPECT_TRUE(work.read(name) == bytes) << name;
  }
}

/// Whole numbers on a grid, z from -1 to 1 with zeros of both signs, shuffled by a seed; a point at
/// several z only if they are equal.
std::string ties(int side, unsigned seed) {
  std::vector<std::string> lines;
  for (int i = 0; i < side * side; ++i) {
    const int x = i % side;
    const int y = i / side;
    const int kind = (x / 5 + 2 * (y / 5)) % 4;  // level, random, falling to north, to west
    const int rise = kind == 0 ? 0 : kind == 1 ? (x * 7 + y * 5) % 11 % 3 - 1 : kind == 2 ? -y : x;
    const std::string z = rise != 0 ? fmt::format("{}", rise) : i % 2 == 0 ? "0" : "-0.0";
    for (int copy = 0; copy <= i % 3 / 2; ++copy)
      lines.push_back(fmt::format("{} {} {}\n", x, y, z));
  }
  std::shuffle(lines.begin(), lines.end(), std::mt19937(seed));
  std::string text;
  for (const std::string& line : lines) text += line;
  return text;
}

TEST(Dem, TiesAndZerosGiveTheSameBytesInEveryOrderAndWay) {
  const Workspace work;
  const std::string dem =
      "spillway dem -q --resolution 0.5 --bounds=-1.25,-1.25,41.25,41.25 "
      "--product height,facet-slope,facet-aspect,facet-hillshade,slope,density --compress none ";
  work.write("in.txt", ties(40, 0));
  work.succeed(
      "spillway triangulate -q in.txt -o tin.spm && spillway triangulate -q in.txt -o tin.obj");
  work.succeed(dem + "in.txt -o one.tif --threads 1");
  const std::string expected = work.read("one.tif");
  const std::vector<std::string> ways = {" --memory 64M --tile-points 64",
                                         " --tile-points 100",
                                         " --leaf-points 7",
                                         " --tile-points 250 --leaf-points 20 --children 3",
                                         " --memory 256M --tile-points 64",
                                         " --division cycling --leaf-points 30",
                                         " --kernel cgal",
                                         " --tile-points 1000"};
  for (unsigned threads = 1; threads <= 8; ++threads) {
    const std::string& way = ways[threads - 1];
    work.write("in.txt", ties(40, threads));
    const std::string with_threads = fmt::format(" --threads {} ", threads);
    work.succeed(dem + "in.txt -o points.tif" + with_threads + way);
    EXPECT_TRUE(work.read("points.tif") == expected) << threads << way;
    work.succeed("spillway triangulate -q in.txt -o tin.spm" + way);
    for (const std::string mesh : {"tin.spm", "tin.obj"}) {
      work.succeed(dem + mesh + " -o mesh.tif" + with_threads);
      EXPECT_TRUE(work.read("mesh.tif") == expected) << mesh << threads << way;
    }
    work.succeed(
        "{ grep ^v tin.obj; grep ^f tin.obj | awk '{ print NR * 7 % 101, $1, $3, $4, $2 }' | "
        "sort -n | cut -d' ' -f2-; } > turned.obj && mv turned.obj tin.obj");
  }
}

TEST(Dem, AFacetThatFallsDueNorthHasNoSayBesideTheOneThatOwnsTheCentre) {
  const Workspace work;
  const std::string vertices = "v 0 0 10\nv 4 8 2\nv -6 8 2\nv 9 1 0\n";
  work.write("one.obj", vertices + "f 1 2 3\nf 1 4 2\n");
  work.write("other.obj", vertices + "f 1 4 2\nf 1 2 3\n");
  for (const std::string name : {"one", "other"}) {
    work.succeed("spillway dem -q " + name + ".obj -o " + name +
                 ".tif --resolution 1 --bounds=-6.5,-0.5,9.5,8.5 --product facet-aspect");
  }
  EXPECT_TRUE(work.read("one.tif") == work.read("other.tif"));
  const OpenedRaster dem(work, "one.tif");
  EXPECT_NEAR(dem.pixels()[6 * 16 + 7], 66.0375, 1e-4);  // the centre (1, 2), on the common edge
  EXPECT_EQ(dem.pixels()[2 * 16 + 6], 0);                // (0, 6), due north
}

TEST(Dem, HeightsEqualToNodataStayValidForGdal) {
  const Workspace work;
  work.write("level.txt", "0 0 7\n10 0 7\n0 10 7\n10 10 7\n");
  work.succeed("spillway dem -q level.txt -o level.tif --resolution 1 --nodata 7");
  const OpenedRaster dem(work, "level.tif");
  double mean = 0;
  ASSERT_EQ(dem.band().ComputeStatistics(0, nullptr, nullptr, &mean, nullptr, nullptr, nullptr),
            CE_None);
  EXPECT_NEAR(mean, 7, 1e-5);
}

TEST(Dem, ProgressCountsThePixelsThatThereAre) {
  const Workspace work;
  work.succeed("spillway generate -q uniform -n 500 --dim 3 -o in.txt");
  const Result dem = work.run(
      "spillway dem in.txt -o dem.tif --resolution 0.005 --bounds 0,0,1,1 --progress json "
      "--product height,slope");
  ASSERT_EQ(dem.exit_code, 0) << dem.err;
  EXPECT_THAT(dem.err, HasSubstr(R"("phase":"write","done":40000,"unit":"pixels","fraction":1.0)"));
  EXPECT_THAT(work.run("spillway dem in.txt -o dem.tif --resolution 0.005 --bounds 0,0,1,1").err,
              HasSubstr("write: 40.0k pixels"));
}

TEST(Dem, ProductsBecomeBandsWithTheirNames) {
  const Workspace work;
  work.write("points.txt", "0 0 0\n10 0 10\n0 10 0\n10 10 10\n");
  work.succeed(
      "spillway dem -q points.txt -o dem.tif --resolution 1 --product "
      "facet-slope,facet-aspect,facet-hillshade --azimuth 270 --altitude 45 --nodata -1");
  const OpenedRaster dem(work, "dem.tif");
  ASSERT_EQ(dem.file().GetRasterCount(), 3);
  EXPECT_STREQ(dem.band(1).GetDescription(), "facet-slope");
  EXPECT_STREQ(dem.band(3).GetDescription(), "facet-hillshade");
  EXPECT_EQ(dem.band(2).GetNoDataValue(), -1);
  EXPECT_THAT(dem.pixels(1), ::testing::Each(45));
  EXPECT_THAT(dem.pixels(2), ::testing::Each(270));
  EXPECT_THAT(dem.pixels(3), ::testing::Each(::testing::FloatNear(255, 1e-4)));
}

TEST(Dem, LikeTakesGridAndCoordinateSystemOfAnotherRaster) {
  const Workspace work;
  work.write("points.txt", surface(20, 1));
  work.succeed("spillway dem -q points.txt -o first.tif --resolution 2 --align");
  {
    const OpenedRaster first(work, "first.tif");
    EXPECT_EQ(first.transform, (std::array{0.0, 2.0, 0.0, 20.0, 0.0, -2.0}));
    EXPECT_EQ(first.columns(), 10);
  }
  {
    GDALDatasetUniquePtr file(
        GDALDataset::Open((work.folder() / "first.tif").c_str(), GDAL_OF_RASTER | GDAL_OF_UPDATE));
    OGRSpatialReference crs;
    crs.importFromEPSG(32633);
    file->SetSpatialRef(&crs);
    std::array<double, 6> moved = {-3, 2.5, 0, 12, 0, -2.5};
    file->SetGeoTransform(moved.data());
  }
  work.succeed("spillway dem -q points.txt -o second.tif --like first.tif");
  const OpenedRaster second(work, "second.tif");
  EXPECT_EQ(second.transform, (std::array{-3.0, 2.5, 0.0, 12.0, 0.0, -2.5}));
  EXPECT_EQ(second.columns(), 10);
  ASSERT_NE(second.file().GetSpatialRef(), nullptr);
  EXPECT_STREQ(second.file().GetSpatialRef()->GetAuthorityCode(nullptr), "32633");
  EXPECT_EQ(second.pixels()[0], -9999);  // west of all points
}

TEST(Dem, CloudOptimizedFilesHaveOverviews) {
  const Workspace work;
  work.succeed(
      "spillway generate -q terrain -n 20000 -o in.las\n"
      "spillway dem -q in.las -o plain.tif --resolution 0.1\n"
      "spillway dem -q in.las -o one.tif --resolution 0.1 --cog --threads 1 --compress zstd\n"
      "spillway dem -q in.las -o two.tif --resolution 0.1 --cog --threads 2 --compress zstd");
  EXPECT_THAT(work.names(), ElementsAre("in.las", "one.tif", "plain.tif", "two.tif"));
  const OpenedRaster cog(work, "one.tif");
  EXPECT_EQ(cog.structure("LAYOUT"), "COG");
  EXPECT_EQ(cog.structure("COMPRESSION"), "ZSTD");
  EXPECT_GE(cog.band().GetOverviewCount(), 1);
  EXPECT_EQ(cog.pixels(), OpenedRaster(work, "plain.tif").pixels());
  EXPECT_TRUE(work.read("one.tif") == work.read("two.tif"));
}

TEST(Dem, UncompressedOnRequest) {
  const Workspace work;
  work.write("points.txt", surface(10, 1));
  work.succeed("spillway dem -q points.txt -o dem.tif --resolution 1 --compress none");
  EXPECT_EQ(OpenedRaster(work, "dem.tif").structure("COMPRESSION"), "");
}

TEST(Dem, FiguresTellTheRastersSizeAndItsData) {
  const Workspace work;
  work.write("points.txt", "0 0 1\n10 0 1\n0 10 1\n");
  const Result result =
      work.run("spillway dem points.txt -o dem.tif --resolution 1 --stats run.json");
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(result.err, HasSubstr("10 x 10 pixels of 1, 55 with data"));
  const auto json = nlohmann::json::parse(work.read("run.json"));
  EXPECT_EQ(json["raster"]["columns"], 10);
  EXPECT_EQ(json["raster"]["pixels_with_data"], 55);
  EXPECT_EQ(json["simplices"], 1);
}

TEST(Dem, NoDataIsTold) {
  const Workspace work;
  work.write("points.txt", surface(10, 1));
  const std::string dem = "spillway dem points.txt -o a.tif --resolution 1 ";
  EXPECT_THAT(
      work.run(dem + "-q --bounds 90,90,95,95").err,
      HasSubstr("warning: no pixel has a value: the raster of 5 x 5 pixels of 1, from 90,90 "
                "to 95,95, lies beside the points"));
}

TEST(Dem, PixelsLargerThanThePointsAreNotCalledBesideThem) {
  const Workspace work;
  work.write("points.txt", surface(10, 1));
  const std::string said = work.run("spillway dem points.txt -o a.tif -q --resolution 500").err;
  EXPECT_THAT(said, HasSubstr("warning: no pixel has a value: pixels of 500 are so large"));
  EXPECT_THAT(said, HasSubstr("give a smaller --resolution"));
  EXPECT_THAT(said, Not(HasSubstr("beside")));
  EXPECT_THAT(work.run("spillway dem points.txt -o b.tif -q --like a.tif").err,
              HasSubstr("choose another --like"));
}

struct Refused {
  const char* name;
  const char* arguments;
  int exit_code;
  const char* message;
};

void PrintTo(const Refused& refused, std::ostream* out) { *out << refused.arguments; }

class DemRefuses : public ::testing::TestWithParam<Refused> {};

TEST_P(DemRefuses, AndLeavesNothing) {
  const Workspace work;
  work.write("points.txt", surface(10, 1));
  work.write("cloud.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  const auto before = work.names();
  const Result result = work.run(std::string("spillway dem -q ") + GetParam().arguments);
  EXPECT_EQ(result.exit_code, GetParam().exit_code) << result.err;
  EXPECT_THAT(result.err, HasSubstr(GetParam().message));
  EXPECT_EQ(work.names(), before);
}

constexpr std::array kRefused = {
    Refused{"NoResolution", "points.txt -o dem.tif", 2, "--resolution"},
    Refused{"NegativeResolution", "points.txt -o dem.tif --resolution -1", 2, "--resolution"},
    Refused{"LikeAndResolution", "points.txt -o dem.tif --resolution 1 --like x.tif", 2, "--like"},
    Refused{"MissingLike", "points.txt -o dem.tif --like x.tif", 1, "x.tif"},
    Refused{"LikeWithoutAPlace", "points.txt -o dem.tif --like points.txt", 1, "points.txt"},
    Refused{"StandardOutput", "points.txt -o - --resolution 1", 2, "needs a file"},
    Refused{"Device", "points.txt -o /dev/null --resolution 1", 2, "needs a file"},
    Refused{"MissingFolder", "points.txt -o no/dem.tif --resolution 1", 1, "create the folder"},
    Refused{"UnknownProduct", "points.txt -o dem.tif --resolution 1 --product height,width", 2,
            "width"},
    Refused{"MisspelledProduct", "points.txt -o dem.tif --resolution 1 --product plan-curvatur", 2,
            "is not a product (did you mean plan-curvature?)"},
    Refused{"FactorOfNothing", "points.txt -o dem.tif --resolution 1 --z-factor 2", 2,
            "--z-factor has no effect without slope, aspect, hillshade or curvature"},
    Refused{"GradientOfNothing",
            "points.txt -o dem.tif --resolution 1 --product tri --gradient horn", 2,
            "--gradient has no effect without slope, aspect or hillshade"},
    Refused{"EdgesOfNothing",
            "points.txt -o dem.tif --resolution 1 --product facet-slope --compute-edges", 2,
            "--compute-edges has no effect without a product of a pixel's neighbours"},
    Refused{"UnknownGradient",
            "points.txt -o dem.tif --resolution 1 --product slope --gradient sobel", 2,
            "--gradient"},
    Refused{"HeightsInBytes", "points.txt -o dem.tif --resolution 1 --type byte", 2,
            "--type byte is for shades, from 1 to 255: height does not fit"},
    Refused{"NodataOfBytes",
            "points.txt -o dem.tif --resolution 1 --type byte --product hillshade --nodata 9", 2,
            "--nodata has no effect on bytes, in which 0 is no data"},
    Refused{"AzimuthOfFourLights",
            "points.txt -o dem.tif --resolution 1 --product multi-hillshade --azimuth 9", 2,
            "--azimuth has no effect without hillshade"},
    Refused{"NoFactor", "points.txt -o dem.tif --resolution 1 --product slope --z-factor 0", 2,
            "\"0\" is not a factor"},
    Refused{"ProductTwice", "points.txt -o dem.tif --resolution 1 --product slope,slope", 2,
            "twice"},
    Refused{"BoundsWithoutArea", "points.txt -o dem.tif --resolution 1 --bounds 1,1,1,5", 2,
            "--bounds"},
    Refused{"NodataIsNoNumber", "points.txt -o dem.tif --resolution 1 --nodata none", 2,
            "--nodata"},
    Refused{"TooManyPixels", "points.txt -o dem.tif --resolution 1e-9", 2, "--resolution"},
    Refused{"TooLittleMemory", "points.txt -o dem.tif --resolution 1 --memory 32M", 2, "--memory"},
    Refused{"EverythingTooLong", "points.txt -o dem.tif --resolution 1 --max-edge 0.01", 1,
            "nothing is left"},
    Refused{"FilteredMesh", "cloud.obj -o dem.tif --resolution 1 --every 2", 2,
            "--every has no effect"},
    Refused{"MissingInput", "nowhere.las -o dem.tif --resolution 1", 1, "nowhere.las"},
};

INSTANTIATE_TEST_SUITE_P(All, DemRefuses, ::testing::ValuesIn(kRefused),
                         [](const auto& test) { return std::string(test.param.name); });

TEST(DemFaults, AFileThatMayNotGrowIsAnErrorAndLeavesNothing) {
  const Workspace work;
  work.succeed("spillway generate -q terrain -n 100000 -o in.las");
  const auto before = work.names();
  for (const char* more : {"", " --cog"}) {
    const Result result = work.run(
        std::string("ulimit -f 100; spillway dem -q in.las -o dem.tif --resolution 0.2") + more);
    EXPECT_EQ(result.exit_code, 1) << result.err;
    EXPECT_THAT(result.err, HasSubstr("cannot write dem.tif"));
    EXPECT_EQ(work.names(), before);
  }
}

TEST(Dem, SidecarsOfTheReplacedRasterAreRemoved) {
  const Workspace work;
  work.write("points.txt", surface(10, 1));
  for (const char* name : {"dem.tif", "dem.tif.ovr", "dem.tif.aux.xml", "dem.tif.msk"}) {
    work.write(name, "old");
  }
  work.write("dem.ovr", "another file's");
  work.succeed("spillway dem -q points.txt -o dem.tif --resolution 1");
  EXPECT_THAT(work.names(), ElementsAre("dem.ovr", "dem.tif", "points.txt"));
}

/// Points whose last line is broken: only who reads them all notices.
std::string broken_at_its_end() { return surface(200, 1) + "no number\n"; }

TEST(DemFaults, MissingPartsOfGdalAreToldBeforeThePointsAreRead) {
  const Workspace work;
  work.write("points.txt", broken_at_its_end());
  const std::string dem = " spillway dem -q points.txt -o dem.tif --resolution 1";
  const Result no_tiff = work.run("GDAL_SKIP=GTiff" + dem);
  EXPECT_EQ(no_tiff.exit_code, 1);
  EXPECT_THAT(no_tiff.err, HasSubstr("cannot write dem.tif: GDAL is installed without its driver"));
  EXPECT_THAT(work.run("GDAL_SKIP=COG" + dem + " --cog").err, HasSubstr("without its driver COG"));
  EXPECT_THAT(work.run("GDAL_SKIP=COG" + dem).err, HasSubstr("points.txt"));
}

TEST(DemFaults, ATooLargeGridIsToldBeforeThePointsAreRead) {
  const Workspace work;
  work.write("points.txt", broken_at_its_end());
  const Result result =
      work.run("spillway dem -q points.txt -o dem.tif --resolution 1e-5 --bounds 0,0,10,10");
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_THAT(result.err, HasSubstr("for its index alone"));
}

/// A square of 400 points and one vertex so far to the north, as text and as a mesh.
void write_far_vertex(const Workspace& work, double north) {
  work.write("far.txt", surface(20, 2) + fmt::format("20 {} 7\n", north));
  work.succeed(
      "spillway triangulate -q far.txt -o far.ply && spillway triangulate -q far.txt -o far.spm");
}

TEST(DemFaults, ManyPixelsForFewPointsAreAskedForFirst) {
  const Workspace work;
  write_far_vertex(work, 410039);
  const auto before = work.names();
  for (const char* const input : {"far.txt", "far.ply", "far.spm", "- < far.spm", "- < far.txt"}) {
    const Result result =
        work.run(fmt::format("spillway dem -q -o out.tif --resolution 1 {}", input));
    EXPECT_EQ(result.exit_code, 1) << input;
    EXPECT_THAT(result.err, HasSubstr("from 0, 0 to 38, 410039"));
    EXPECT_THAT(result.err, HasSubstr("38 x 410039 pixels"));
    EXPECT_THAT(result.err, HasSubstr("--bounds"));
    EXPECT_THAT(result.err, HasSubstr("--resolution"));
    EXPECT_THAT(result.err, HasSubstr("--force-size"));
    EXPECT_EQ(work.names(), before) << input;
  }
}

TEST(Dem, ManyPixelsForFewPointsAreMadeOnDemand) {
  const Workspace work;
  write_far_vertex(work, 300000);
  for (const char* const how :
       {"--resolution 1 --force-size", "--resolution 1 --bounds 0,0,38,38", "--resolution 2"}) {
    work.succeed(fmt::format("spillway dem -q far.txt -o out.tif {}", how));
  }
  work.succeed("spillway dem -q far.txt -o like.tif --like out.tif");
  const Result bounded =
      work.run("spillway dem -q far.txt -o a.tif --resolution 1 --bounds 0,0,9,9 --force-size");
  EXPECT_EQ(bounded.exit_code, 2);
  EXPECT_THAT(bounded.err,
              HasSubstr("--force-size has no effect with --bounds, which tells what to cover"));
  EXPECT_EQ(work.run("spillway dem -q far.txt -o a.tif --like out.tif --force-size").exit_code, 2);
}

TEST(Dem, ManyPixelsForManyPointsAreANotice) {
  const Workspace work;
  work.write("far.txt", surface(100, 2) + "20 60000 7\n");
  work.succeed("spillway triangulate -q far.txt -o far.spm");
  for (const std::string input : {"far.txt", "far.spm"}) {
    const std::string dem = "spillway dem -o out.tif --resolution 1 " + input;
    EXPECT_THAT(work.run(dem).err,
                HasSubstr("the raster has 198 x 60000 pixels, for 10001 vertices; some of them may "
                          "lie far away: bounds say what to cover"));
    EXPECT_THAT(work.run(dem + " --bounds 0,0,198,198").err, Not(HasSubstr("far away")));
  }
}

TEST(DemFaults, AFailedRunKeepsTheFileThatWasThere) {
  const Workspace work;
  work.write("dem.tif", "old");
  work.write("points.txt", "0 0 0\n1 1 1\n2 2 2\n");
  const Result result = work.run("spillway dem -q points.txt -o dem.tif --resolution 1");
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_EQ(work.read("dem.tif"), "old");
}

TEST(DemFaults, PointsWithoutHeightsHaveNone) {
  Workspace space;
  space.write("flat.csv", "x,y\n0,0\n5,0\n0,5\n5,5\n");
  for (const std::string what :
       {"dem flat.csv -o a.tif --resolution 1", "contour flat.csv -o a.geojson --interval 1"}) {
    const Result result = space.run("spillway " + what);
    EXPECT_EQ(result.exit_code, 1);
    EXPECT_THAT(result.err, HasSubstr("flat.csv: the points have no z"));
  }
  space.succeed("spillway dem flat.csv -o a.tif --resolution 1 --product density");
  EXPECT_EQ(space.names(), (std::vector<std::string>{"a.tif", "flat.csv"}));
}

}  // namespace
}  // namespace spillway::test
