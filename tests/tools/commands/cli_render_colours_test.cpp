// `render --color`, and what stands below and beside a picture.

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "tests/tools/command_runner.h"
#include "tests/tools/commands/opened_picture.h"

namespace spillway::test {
namespace {

using ::testing::HasSubstr;

constexpr int kSide = 9;

/// A level grid of points, one a unit, with what `numbers` gives for each.
template <typename Numbers>
std::string level_points(const std::string& names, const Numbers& numbers) {
  std::string text = "x,y,z," + names + "\n";
  for (int i = 0; i < kSide * kSide; ++i) {
    text += fmt::format("{},{},7,{}\n", i % kSide, i / kSide, numbers(i % kSide, i / kSide));
  }
  return text;
}

int class_at(int x, int y) { return 2 + (3 * x + 5 * y + x * y) % 5; }

TEST(RenderColours, APixelHasTheClassOfTheNearestPoint) {
  const Workspace work;
  work.write("in.csv", level_points("classification", class_at));
  work.succeed("spillway render -q in.csv -o view.png --color class --size 172");
  const OpenedPicture view(work, "view.png");
  ASSERT_EQ(view.columns(), 172);
  // As docs/render.md has them: ground, low, medium and high vegetation, building.
  const std::array<std::array<int, 3>, 5> colours = {
      {{191, 144, 94}, {186, 214, 120}, {112, 184, 82}, {42, 128, 62}, {214, 82, 72}}};
  // 20 pixels a unit, behind a margin of 6.
  int compared = 0;
  for (int row = 7; row < 165; ++row) {
    for (int column = 7; column < 165; ++column) {
      const double x = (column + 0.5 - 6) / 20;
      const double y = 8 - (row + 0.5 - 6) / 20;
      const int i = static_cast<int>(std::lround(x));
      const int j = static_cast<int>(std::lround(y));
      // Beside the line between two points samples are of both.
      if (std::abs(x - i) > 0.45 || std::abs(y - j) > 0.45) continue;
      ++compared;
      ASSERT_EQ(view.colour(column, row), colours[class_at(i, j) - 2]) << x << ' ' << y;
    }
  }
  EXPECT_GT(compared, 15'000);
}

TEST(RenderColours, RgbIsAsThePointsHaveItIn8And16Bits) {
  const Workspace work;
  const auto rgb = [](int factor) {
    return [factor](int x, int y) {
      return fmt::format("{},{},{}", 25 * x * factor, 30 * y * factor, (x + y) * 15 * factor);
    };
  };
  work.write("bytes.csv", level_points("red,green,blue", rgb(1)));
  work.write("words.csv", level_points("red,green,blue", rgb(257)));
  work.succeed(
      "spillway render -q bytes.csv -o a.png --color rgb --size 172\n"
      "spillway render -q words.csv -o b.png --color rgb --size 172");
  EXPECT_TRUE(work.read("a.png") == work.read("b.png"));
  const OpenedPicture view(work, "a.png");
  for (int i = 1; i < kSide - 1; ++i) {
    for (int j = 1; j < kSide - 1; ++j) {
      const std::array<int, 3> expected = {25 * i, 30 * j, (i + j) * 15};
      EXPECT_EQ(view.colour(6 + 20 * i, 6 + 20 * (8 - j)), expected) << i << ' ' << j;
    }
  }
}

TEST(RenderColours, IntensitiesRangeFromDarkToLight) {
  const Workspace work;
  work.write("in.csv", level_points("intensity", [](int x, int /*y*/) { return 100 * x; }));
  const Result result =
      work.run("spillway render in.csv -o view.png --color intensity --size 172 --legend");
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(result.err, HasSubstr("intensities from 0 to 800"));
  const OpenedPicture view(work, "view.png");
  for (int i = 1; i < kSide; ++i) {
    const auto [red, green, blue] = view.colour(6 + 20 * i - 2, 86);
    EXPECT_EQ(red, green);
    EXPECT_EQ(green, blue);
    EXPECT_NEAR(red, 255 * (0.15 + 0.8 * i / 8), 1) << i;
  }
}

TEST(RenderColours, ThreadsTilesMemoryAndWaysThroughMeshesGiveTheSameBytes) {
  const auto file = shared_file("autzen_trim.las");
  if (file.empty()) GTEST_SKIP() << "the shared sample data is not there";
  const Workspace work;
  work.succeed(
      fmt::format("spillway triangulate -q '{0}' -o tin.spm --attributes all\n"
                  "spillway triangulate -q '{0}' -o tin.ply --attributes all",
                  file.string()));
  for (const std::string colour : {"rgb", "class", "return", "intensity"}) {
    const std::string how = " --size 700 --max-edge 60 --legend -q --color " + colour;
    const std::string options = colour == "rgb" ? " --size 700 --max-edge 60 -q --color rgb" : how;
    work.succeed(fmt::format(
        "spillway render '{0}' -o one.png --threads 1 {1}\n"
        "spillway render '{0}' -o tiles.png --threads 2 --tile-points 3000 --leaf-points 300 {1}\n"
        "spillway render '{0}' -o small.png --memory 64M {1}\n"
        "spillway render tin.spm -o spm.png {1}",
        file.string(), options));
    const std::string bytes = work.read("one.png");
    EXPECT_GT(bytes.size(), 10'000U);
    for (const char* name : {"tiles.png", "small.png", "spm.png"}) {
      EXPECT_TRUE(work.read(name) == bytes) << name << ' ' << colour;
    }
  }
  // PLY has colours in 8 bits.
  work.succeed(
      "spillway render tin.ply -o ply.png --size 700 --color class -q --max-edge 60 --legend");
  work.succeed(
      fmt::format("spillway render '{}' -o one.png --size 700 --color class -q --max-edge 60 "
                  "--legend",
                  file.string()));
  EXPECT_TRUE(work.read("ply.png") == work.read("one.png"));
}

/// Rows and columns of pixels in a box that are darker than the background.
int dark_pixels(const OpenedPicture& view, int row_begin, int row_end) {
  int count = 0;
  for (int row = row_begin; row < row_end; ++row) {
    for (int column = 0; column < view.columns(); ++column) {
      if (view.brightness(column, row) < 200) ++count;
    }
  }
  return count;
}

TEST(RenderWords, StandBelowThePicture) {
  const Workspace work;
  work.write("in.csv", level_points("classification", class_at));
  work.succeed(
      "spillway render -q in.csv -o plain.png --color class --size 400\n"
      "spillway render -q in.csv -o bar.png --color class --size 400 --scale-bar\n"
      "spillway render -q in.csv -o both.png --color class --size 400 --scale-bar --legend\n"
      "spillway render -q in.csv -o clear.png --color class --size 400 --legend --transparent");
  const OpenedPicture plain(work, "plain.png");
  const OpenedPicture bar(work, "bar.png");
  const OpenedPicture both(work, "both.png");
  const OpenedPicture clear(work, "clear.png");
  EXPECT_EQ(plain.rows(), 400);
  EXPECT_GT(bar.rows(), 410);
  EXPECT_GT(both.rows(), bar.rows());
  for (int row = 0; row < plain.rows(); row += 3) {
    for (int column = 0; column < plain.columns(); column += 3) {
      ASSERT_EQ(both.colour(column, row), plain.colour(column, row));
    }
  }
  // The longest bar of 1, 2 or 5 times a power of ten in a quarter of 400 pixels, 48.5 a unit.
  int longest = 0;
  for (int row = 400; row < bar.rows(); ++row) {
    int length = 0;
    for (int column = 0; column < bar.columns(); ++column) {
      length = bar.brightness(column, row) < 200 ? length + 1 : 0;
      longest = std::max(longest, length);
    }
  }
  EXPECT_NEAR(longest, 2 * 388 / 8.0, 2);
  EXPECT_GT(dark_pixels(both, 400, both.rows()), dark_pixels(bar, 400, bar.rows()) + 500);
  EXPECT_EQ(clear.opacity(2, clear.rows() - 2), 0);
  EXPECT_GT(dark_pixels(clear, 400, clear.rows()), 500);
}

TEST(RenderPlace, AWorldFileTellsWhereTheUpperLeftPixelLies) {
  const Workspace work;
  work.write("in.txt", "500 900 1\n510 900 1\n500 905 1\n510 905 2\n");
  work.succeed(
      "spillway render -q in.txt -o view.png --size 100 --world-file --zoom 500,900,510,905");
  EXPECT_EQ(work.read("view.pgw"), "0.1\n0\n0\n-0.1\n500.05\n904.95\n");
}

TEST(RenderPlace, AGeoTiffHasThePixelsOfATransparentPictureAndItsPlace) {
  if (build_lacks("GDAL")) GTEST_SKIP() << kNoGdal;
  const Workspace work;
  if (work.run("command -v gdal_translate").exit_code != 0) GTEST_SKIP() << "no gdal_translate";
  work.write("in.csv", level_points("classification", class_at));
  work.succeed(
      "spillway render -q in.csv -o view.tif --size 300 --color class --crs EPSG:26911\n"
      "spillway render -q in.csv -o view.png --size 300 --color class --transparent\n"
      "gdal_translate -q -of PNG view.tif again.png && gdalinfo -json view.tif > info.json");
  const OpenedPicture again(work, "again.png");
  const OpenedPicture view(work, "view.png");
  ASSERT_EQ(again.columns(), view.columns());
  ASSERT_EQ(again.rows(), view.rows());
  for (int row = 0; row < view.rows(); ++row) {
    for (int column = 0; column < view.columns(); ++column) {
      ASSERT_EQ(again.colour(column, row), view.colour(column, row)) << column << ' ' << row;
      ASSERT_EQ(again.opacity(column, row), view.opacity(column, row)) << column << ' ' << row;
    }
  }
  const auto info = nlohmann::json::parse(work.read("info.json"));
  const double side = 8.0 / (300 - 12);
  const auto place = info["geoTransform"].get<std::vector<double>>();
  EXPECT_NEAR(place[0], -6 * side, 1e-9);
  EXPECT_NEAR(place[1], side, 1e-12);
  EXPECT_NEAR(place[3], 8 + 6 * side, 1e-9);
  EXPECT_THAT(info["coordinateSystem"]["wkt"].get<std::string>(), HasSubstr("UTM zone 11N"));
  EXPECT_EQ(info["bands"][3]["colorInterpretation"], "Alpha");
  work.succeed(
      "spillway render -q in.csv -o again.tif --size 300 --color class --crs EPSG:26911 "
      "--threads 1");
  EXPECT_TRUE(work.read("again.tif") == work.read("view.tif"));
}

struct Refused {
  const char* name;
  const char* arguments;
  const char* message;
};

void PrintTo(const Refused& refused, std::ostream* out) { *out << refused.arguments; }

class RenderColoursRefuse : public ::testing::TestWithParam<Refused> {};

TEST_P(RenderColoursRefuse, AndLeaveNothing) {
  const Workspace work;
  work.write("in.csv", level_points("classification", class_at));
  const auto before = work.names();
  const Result result = work.run(std::string("spillway render -q in.csv ") + GetParam().arguments);
  EXPECT_EQ(result.exit_code, 2) << result.err;
  EXPECT_THAT(result.err, HasSubstr(GetParam().message));
  EXPECT_EQ(work.names(), before);
}

constexpr std::array kRefused = {
    Refused{"NumbersThatAreNotThere", "-o a.png --color rgb", "no attribute \"red\""},
    Refused{"NoColour", "-o a.png --color pink", "--color"},
    Refused{"RampOfClasses", "-o a.png --color class --ramp grey", "a ramp is for heights"},
    Refused{"LegendOfColours", "-o a.png --color rgb --legend", "a legend has nothing to tell"},
    Refused{"ColoursInSpace", "-o a.png --color class --dim 3", "colours are chosen of terrains"},
    Refused{"LegendInSpace", "-o a.png --legend --dim 3", "a legend, a scale bar and a world file"},
    Refused{"GeoTiffInSpace", "-o a.tif --dim 3", "a GeoTIFF lies on a map"},
    Refused{"WordsOnAMap", "-o a.tif --scale-bar", "where no words go"},
    Refused{"TransparentGeoTiff", "-o a.tif --transparent", "transparent anyway"},
    Refused{"WorldFileOfAGeoTiff", "-o a.tif --world-file", "tells its place itself"},
    Refused{"WorldFileThatIsForStatistics", "-o a.png --world-file --stats a.pgw", "world file"},
    Refused{"WorldFileOfAPipe", "-o - --world-file | cat; exit 2", "lies beside its picture"},
    Refused{"ColoursOfAPageThatAreNotThere", "-o a.html --color rgb", "no attribute \"red\""},
    Refused{"LegendOfAPage", "-o a.html --legend", "a page has no legend but its own"},
};

INSTANTIATE_TEST_SUITE_P(All, RenderColoursRefuse, ::testing::ValuesIn(kRefused),
                         [](const auto& test) { return std::string(test.param.name); });

}  // namespace
}  // namespace spillway::test
