// `render -o FILE.html`: what a page holds, all ways to the same bytes, and what is refused. How it
// looks in a browser is for view_in_browser.py.

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "tests/tools/command_runner.h"

namespace spillway::test {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;

/// The relief in a page, as a browser decodes it.
struct Page {
  Page(const Workspace& work, const std::string& name) : text(work.read(name)) {
    const std::string before = R"(<script id="relief" type="application/json">)";
    const std::size_t begin = text.find(before) + before.size();
    json = nlohmann::json::parse(text.substr(begin, text.find("</script>", begin) - begin));
    columns = json["columns"];
    rows = json["rows"];
    const std::string_view digits =
        "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string bytes;
    std::uint32_t bits = 0;
    int held = 0;
    for (const char digit : json["heights"].get<std::string>()) {
      if (digit == '=') break;
      bits = bits << 6U | static_cast<std::uint32_t>(digits.find(digit));
      held += 6;
      if (held < 8) continue;
      held -= 8;
      bytes += static_cast<char>(bits >> held & 0xFFU);
    }
    for (std::size_t i = 0; i + 1 < bytes.size(); i += 2) {
      const int step =
          static_cast<unsigned char>(bytes[i]) + 256 * static_cast<unsigned char>(bytes[i + 1]);
      const double way = json["highest"].get<double>() - json["lowest"].get<double>();
      heights.push_back(step == 0xFFFF ? NAN : json["lowest"].get<double>() + step * way / 0xFFFE);
    }
  }

  [[nodiscard]] int triangles() const {
    int count = 0;
    for (int i = 0; i + columns < static_cast<int>(heights.size()); ++i) {
      if (i % columns + 1 == columns) continue;
      const double all =
          heights[i] + heights[i + 1] + heights[i + columns] + heights[i + columns + 1];
      if (!std::isnan(all)) count += 2;
    }
    return count;
  }

  std::string text;
  nlohmann::json json;
  int columns = 0;
  int rows = 0;
  std::vector<double> heights;  ///< not a number where there is none
};

/// A plane over 0 to 40 and 0 to 20, without the points of a square in the middle.
std::string plane_with_a_hole() {
  std::string text;
  for (int i = 0; i < 41 * 21; ++i) {
    const int x = i % 41;
    const int y = i / 41;
    if (std::abs(x - 20) < 6 && std::abs(y - 10) < 6) continue;
    text += fmt::format("{} {} {}\n", x, y, 100 + 2 * x - 3 * y);
  }
  return text;
}

TEST(RenderPage, HoldsTheHeightsOfTheTerrain) {
  const Workspace work;
  work.write("plane.txt", plane_with_a_hole());
  work.succeed("spillway render -q plane.txt -o view.html --triangles 3000 --max-edge 3");
  EXPECT_THAT(work.names(), ElementsAre("plane.txt", "view.html"));
  const Page page(work, "view.html");
  ASSERT_EQ(page.heights.size(), static_cast<std::size_t>(page.columns) * page.rows);
  const double side = page.json["side"];
  EXPECT_NEAR(side * page.columns, 40, side);
  EXPECT_NEAR(side * page.rows, 20, side);
  const double range = page.json["highest"].get<double>() - page.json["lowest"].get<double>();
  EXPECT_NEAR(range, 140, 6 * side);
  int without = 0;
  for (int i = 0; i < page.columns * page.rows; ++i) {
    const double x = (i % page.columns + 0.5) * side;
    const int row = i / page.columns;
    const double y = 20 - (row + 0.5) * side;
    const bool in_hole = std::abs(x - 20) < 6 && std::abs(y - 10) < 6;
    const bool near_edge =
        std::abs(std::abs(x - 20) - 6) < 1.5 || std::abs(std::abs(y - 10) - 6) < 1.5;
    const bool inside = x < 40 - side && y > side;
    if (near_edge || !inside) continue;
    ASSERT_EQ(std::isnan(page.heights[i]), in_hole) << x << ' ' << y;
    if (in_hole)
      ++without;
    else
      EXPECT_NEAR(page.heights[i], 100 + 2 * x - 3 * y, range / 65534 + 1e-4) << x << ' ' << y;
  }
  EXPECT_GT(without, 100);
}

TEST(RenderPage, NeedsNothingFromOutside) {
  const Workspace work;
  work.write("plane.txt", plane_with_a_hole());
  work.succeed("spillway render -q plane.txt -o view.html");
  const Page page(work, "view.html");
  for (const char* way : {"://", "url(", " src=", "@import", "import(", "fetch(", "XMLHttp"}) {
    EXPECT_THAT(page.text, Not(HasSubstr(way)));
  }
  EXPECT_THAT(page.text, HasSubstr("default-src 'none'")) << "browsers refuse what is outside";
  EXPECT_THAT(page.text, HasSubstr("<title>view</title>"));
}

TEST(RenderPage, IsThinnedToTheTrianglesAskedForAndTellsOfHowMany) {
  const Workspace work;
  work.succeed("spillway generate -q terrain -n 30000 -o in.las");
  for (const int most : {1000, 20'000, 200'000}) {
    const Result result = work.run(
        fmt::format("spillway render in.las -o view.html --triangles {} --stats run.json", most));
    ASSERT_EQ(result.exit_code, 0) << result.err;
    const Page page(work, "view.html");
    const int cells = 2 * (page.columns - 1) * (page.rows - 1);
    EXPECT_LE(cells, most);
    EXPECT_GT(cells, most * 9 / 10) << "as many as it may";
    const auto run = nlohmann::json::parse(work.read("run.json"));
    EXPECT_EQ(run["picture"]["triangles"], page.triangles());
    EXPECT_EQ(run["picture"]["columns"], page.columns);
    EXPECT_EQ(run["picture"]["rows"], page.rows);
    const std::string told =
        fmt::format("{} triangles on {} x {} heights", page.triangles(), page.columns, page.rows);
    const std::string whole = fmt::format("of {} triangles", run["simplices"].get<int>());
    EXPECT_THAT(result.err, AllOf(HasSubstr(told), HasSubstr(whole)));
    EXPECT_THAT(page.json["facts"].get<std::string>(), AllOf(HasSubstr(told), HasSubstr(whole)));
  }
}

TEST(RenderPage, BeginsAsOptionsSay) {
  const Workspace work;
  work.write("plane.txt", plane_with_a_hole());
  work.succeed(
      "spillway render -q plane.txt -o a.html --view 100,20 --exaggerate 3 --ramp viridis "
      "--zoom 0,0,10,5\n"
      "spillway render -q plane.txt -o b.html");
  const Page given(work, "a.html");
  EXPECT_EQ(given.json["view"], nlohmann::json({100, 20}));
  EXPECT_EQ(given.json["exaggeration"], 3);
  EXPECT_EQ(given.json["ramp"], "viridis");
  EXPECT_NEAR(given.json["side"].get<double>() * given.columns, 10, 0.1);
  EXPECT_NEAR(given.json["side"].get<double>() * given.rows, 5, 0.1);
  const Page usual(work, "b.html");
  EXPECT_EQ(usual.json["ramp"], "relief");
  EXPECT_EQ(usual.json["view"], nlohmann::json({200, 40}));
  EXPECT_LT(usual.json["exaggeration"], 1) << "slopes of more than 3";
}

TEST(RenderPage, ThreadsTilesMemoryAndWaysThroughMeshesGiveTheSameBytes) {
  const Workspace work;
  work.succeed(
      "mkdir a b c d e f\n"
      "spillway generate -q terrain -n 50000 -o in.las\n"
      "spillway triangulate -q in.las -o tin.spm\n"
      "spillway triangulate -q in.las -o tin.ply\n"
      "spillway render -q in.las -o a/view.html --threads 1\n"
      "spillway render -q in.las -o b/view.html --threads 2 --tile-points 2000 --leaf-points 300\n"
      "spillway render -q in.las -o c/view.html --memory 64M\n"
      "spillway render -q tin.spm -o d/view.html\n"
      "spillway render -q tin.ply -o e/view.html\n"
      "spillway render -q - -o f/view.html < in.las");
  const std::string bytes = work.read("a/view.html");
  EXPECT_GT(bytes.size(), 100'000U);
  for (const char* folder : {"b", "c", "d", "e", "f"}) {
    EXPECT_TRUE(work.read(std::string(folder) + "/view.html") == bytes) << folder;
  }
}

TEST(RenderPage, ThatMayNotGrowIsAnErrorAndLeavesNothing) {
  const Workspace work;
  work.succeed("spillway generate -q terrain -n 20000 -o in.las");
  const auto before = work.names();
  const Result result = work.run("ulimit -f 20; spillway render -q in.las -o view.html");
  EXPECT_EQ(result.exit_code, 1) << result.err;
  EXPECT_THAT(result.err, HasSubstr("view.html"));
  EXPECT_EQ(work.names(), before);
}

struct Refused {
  const char* name;
  const char* arguments;
  int exit_code;
  const char* message;
};

void PrintTo(const Refused& refused, std::ostream* out) { *out << refused.arguments; }

class RenderPageRefuses : public ::testing::TestWithParam<Refused> {};

TEST_P(RenderPageRefuses, AndLeavesNothing) {
  const Workspace work;
  work.write("points.txt", "0 0 0\n1 0 1\n0 1 2\n1 1 1\n0.5 0.5 3\n");
  work.write("line.txt", "0 0 0\n5000 0 1\n0 2 1\n5000 2 0\n");
  const auto before = work.names();
  const Result result = work.run(std::string("spillway render -q ") + GetParam().arguments);
  EXPECT_EQ(result.exit_code, GetParam().exit_code) << result.err;
  EXPECT_THAT(result.err, HasSubstr(GetParam().message));
  EXPECT_EQ(work.names(), before);
}

constexpr std::array kRefused = {
    Refused{"PixelsOfAPage", "points.txt -o a.html --size 500", 2, "a page has no size in pixels"},
    Refused{"WireframeOfAPage", "points.txt -o a.html --wireframe", 2, "a page has no wireframe"},
    Refused{"TransparentPage", "points.txt -o a.html --transparent", 2,
            "a page has no transparent"},
    Refused{"SliceOfAPage", "points.txt -o a.html --slice z=1", 2, "a slice is of tetrahedra"},
    Refused{"PageOfTetrahedra", "points.txt --dim 3 -o a.html", 2, "a page shows a terrain"},
    Refused{"TrianglesOfAPicture", "points.txt -o a.png --triangles 5000", 2, "is of a page"},
    Refused{"TooFewTriangles", "points.txt -o a.html --triangles 10", 2, "--triangles"},
    Refused{"TooManyTriangles", "points.txt -o a.html --triangles 10000001", 2, "--triangles"},
    Refused{"MoreThanTheMemory", "points.txt -o a.html --triangles 10000000 --memory 100M", 2,
            "--memory 153M is enough"},
    Refused{"RampThatIsNone", "points.txt -o a.html --ramp rainbow", 2, "--ramp"},
    Refused{"RampOfTetrahedra", "points.txt --dim 3 -o a.png --ramp grey", 2,
            "colours are chosen of terrains"},
    Refused{"TooNarrow", "line.txt -o a.html --triangles 1000", 1, "give it more triangles"},
    Refused{"ZoomBesideThePoints", "points.txt -o a.html --zoom 7,7,8,8", 1, "beside"},
};

INSTANTIATE_TEST_SUITE_P(All, RenderPageRefuses, ::testing::ValuesIn(kRefused),
                         [](const auto& test) { return std::string(test.param.name); });

}  // namespace
}  // namespace spillway::test
