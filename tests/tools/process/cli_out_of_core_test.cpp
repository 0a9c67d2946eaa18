// Points that do not fit into the memory that is allowed: the same mesh as ever, in any format, for
// any tiles and threads; little is written to the disk, and nothing stays there.

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <sstream>
#include <string>
#include <vector>

#include "tests/tools/command_runner.h"

namespace spillway::test {
namespace {

using ::testing::HasSubstr;

/// Enough to overflow what waits in memory under the least --memory for two dimensions.
constexpr int kPoints = 800'000;

/// A folder with temporary files in `tmp`, which must be empty after each run.
class OutOfCore : public ::testing::Test {
 protected:
  OutOfCore() { std::filesystem::create_directory(work_.folder() / "tmp"); }

  /// Triangulates with the least memory and returns the statistics, among which are spilled points.
  [[nodiscard]] nlohmann::json spill(const std::string& arguments,
                                     const std::string& before = "") const {
    nlohmann::json stats = triangulate("--memory 32M " + arguments, before);
    EXPECT_GT(stats["spilled_points"], 0) << arguments;
    return stats;
  }

  [[nodiscard]] nlohmann::json triangulate(const std::string& arguments,
                                           const std::string& before = "") const {
    work_.succeed(before + "spillway triangulate -q --scratch-folder tmp --stats stats.json " +
                  arguments);
    EXPECT_TRUE(std::filesystem::is_empty(work_.folder() / "tmp")) << arguments;
    return nlohmann::json::parse(work_.read("stats.json"));
  }

  [[nodiscard]] nlohmann::json check(const std::string& arguments) const {
    return nlohmann::json::parse(work_.succeed("spillway check -q --json " + arguments));
  }

  void generate(int count, const std::string& name, int seed = 1) const {
    work_.succeed(
        fmt::format("spillway generate -q terrain -n {} --seed {} -o {}", count, seed, name));
  }

  Workspace work_;
};

TEST_F(OutOfCore, ChainGivesWhatFilesGive) {
  generate(200'000, "in.las");
  const auto stats = triangulate("in.las -o mesh.spm");
  const std::string chain =
      "spillway generate -q terrain -n 200000 | spillway triangulate -q - -o - | ";
  const auto info = nlohmann::json::parse(work_.succeed(chain + "spillway info -q --json -"));
  const auto report = nlohmann::json::parse(work_.succeed(chain + "spillway check -q --json -"));
  for (const char* key : {"canonical_hash", "vertices", "simplices", "hull_facets"}) {
    EXPECT_EQ(info[key], stats[key]) << key;
    EXPECT_EQ(report[key], stats[key]) << key;
  }
  EXPECT_EQ(info["points"], 200'000);
}

TEST_F(OutOfCore, HashDoesNotDependOnTilesNorMemoryNorThreads) {
  generate(100'000, "in.las");
  const auto expected = triangulate("in.las -o mesh.spm")["canonical_hash"];
  for (const std::string options :
       {"--tile-points 5000 --memory 64M", "--tile-points 3000 --leaf-points 100 --threads 1",
        "--tile-points 20000 --leaf-points 700 --children 8 --threads 4",
        "--tile-points 1000 --division cycling --children 3",
        "--tile-points 40000 --division constant"}) {
    EXPECT_EQ(triangulate("in.las -o mesh.spm " + options)["canonical_hash"], expected) << options;
    EXPECT_EQ(check("mesh.spm --points in.las")["canonical_hash"], expected) << options;
  }
}

TEST_F(OutOfCore, TetrahedraOfManyTilesAreTheSameInEveryFormat) {
  work_.succeed("spillway generate -q uniform -n 6000 --dim 3 -o in.npy");
  const std::string options = "in.npy --dim 3 --leaf-points 400 ";
  const auto expected = triangulate(options + "-o whole.spm")["canonical_hash"];
  for (const std::string name : {"mesh.spm", "mesh.ply", "mesh.vtu", "mesh.npy"}) {
    const auto stats = triangulate(fmt::format("{} --tile-points 1500 -o {}", options, name));
    EXPECT_GT(stats["tiles"], 3);
    EXPECT_EQ(stats["canonical_hash"], expected) << name;
    EXPECT_EQ(check(fmt::format("{} --points in.npy", name))["canonical_hash"], expected) << name;
  }
}

class OutOfCoreFormat : public OutOfCore, public ::testing::WithParamInterface<std::string> {};

TEST_P(OutOfCoreFormat, HasTheSameBytesForAnyThreadsAndIsProved) {
  const std::string format = GetParam();
  generate(kPoints, "in.las");
  nlohmann::json stats;
  for (const std::string threads : {"1", "2", "4"}) {
    stats =
        spill(fmt::format("--tile-points 30000 --threads {0} in.las -o {0}.out --output-format {1}",
                          threads, format));
  }
  work_.succeed(
      "for f in 1.out*; do rest=${f#1}; cmp $f 2$rest; cmp $f 4$rest; done\n"
      "rm -f 2.out* 4.out*");
  const auto report = check("1.out --points in.las --mesh-format " + format);
  EXPECT_EQ(report["canonical_hash"], stats["canonical_hash"]);
  EXPECT_EQ(report["vertices"], stats["vertices"]);
}

INSTANTIATE_TEST_SUITE_P(Formats, OutOfCoreFormat,
                         ::testing::Values("spm", "sma", "ply", "obj", "vtu", "npy"),
                         [](const auto& test) { return test.param; });

TEST_F(OutOfCore, BytesDoNotDependOnHowAPipeDripsNorOnWhetherItIsAFile) {
  generate(kPoints, "in.las");
  (void)spill("in.las -o file.spm");
  (void)spill("- -o pipe.spm", "cat in.las | ");
  (void)spill("- -o drips.spm",
              "{ head -c 1001; dd bs=5003 status=none; } < in.las | dd bs=777 status=none | ");
  work_.succeed("cmp file.spm pipe.spm; cmp file.spm drips.spm");
}

TEST_F(OutOfCore, APointIsSpilledOnceIfTheHeaderTellsTheTruthElseTwiceAtMost) {
  generate(kPoints, "in.las");
  generate(kPoints, "in.txt");
  const auto told = spill("in.las -o mesh.spm");
  EXPECT_LE(told["spilled_points"], 1.02 * kPoints);
  EXPECT_LE(told["spilled_bytes"], 10 * kPoints);
  const auto untold = spill("- -o mesh.spm", "cat in.txt | ");
  EXPECT_LE(untold["spilled_points"], 2 * kPoints);
  work_.succeed("sort -n in.txt > sorted.txt");
  const auto sorted = spill("- -o mesh.spm", "cat sorted.txt | ");
  EXPECT_LE(sorted["spilled_points"], 2 * kPoints);
  EXPECT_EQ(sorted["canonical_hash"], untold["canonical_hash"]);
}

TEST_F(OutOfCore, StatsTellWhatWasSpilledAndWhatStayed) {
  generate(kPoints, "in.las");
  const auto stats = spill("in.las -o mesh.spm");
  for (const char* key :
       {"memory_limit", "peak_rss_bytes", "output_bytes", "tiles", "tile_capacity", "leaves",
        "leaf_size", "spilled_points", "spilled_bytes", "final", "retriangulated_points",
        "border_simplices", "border_bytes", "stages", "phases"}) {
    EXPECT_TRUE(stats.contains(key)) << key;
  }
  EXPECT_EQ(stats["memory_limit"], 32 << 20);
  EXPECT_EQ(stats["output_bytes"], std::filesystem::file_size(work_.folder() / "mesh.spm"));
  EXPECT_GT(stats["tiles"], 1);
  EXPECT_GE(stats["leaves"], stats["tiles"]);
  EXPECT_GT(stats["border_simplices"], 0);
  EXPECT_LT(stats["border_simplices"], stats["simplices"].get<int>() / 10);
  const auto& final = stats["final"];
  std::uint64_t all = final["in_leaves"].get<std::uint64_t>() + final["in_tiles"].get<int>();
  for (const auto& level : final["by_level"]) all += level.get<std::uint64_t>();
  EXPECT_EQ(all, stats["simplices"].get<std::uint64_t>() + stats["hull_facets"].get<int>());
  for (const char* stage : {"read", "deal", "spill", "load", "divide", "leaves", "finality",
                            "merge", "encode", "write"}) {
    EXPECT_GT(stats["stages"][stage], 0.0) << stage;
  }
  for (const char* phase : {"read", "divide", "triangulate", "write"}) {
    EXPECT_TRUE(stats["phases"].contains(phase)) << phase;
  }
}

/// The doubles or 64-bit integers of an array file, row after row.
template <typename T>
std::vector<T> array_of(const std::string& npy) {
  const std::size_t begin = npy.find('\n') + 1;  // the header ends with the first line
  std::vector<T> values((npy.size() - begin) / sizeof(T));
  std::memcpy(values.data(), npy.data() + begin, values.size() * sizeof(T));
  return values;
}

/// Places with three points each, in three files; every place comes once in every file, so its
/// points are far apart in the input.
constexpr int kPlaces = 250'000;

std::string places(int height, bool backwards) {
  std::string text;
  for (int i = 0; i < kPlaces; ++i) {
    const std::int64_t place = backwards ? kPlaces - 1 - i : i;
    text += fmt::format("{} {} {}\n", place * 7919 % 100'003, place, height + 20 * (place % 50));
  }
  return text;
}

TEST_F(OutOfCore, DuplicatesThatWereSpilledGiveTheHeightAndIndexAskedFor) {
  work_.write("a.txt", places(5, false));
  work_.write("b.txt", places(2, true));
  work_.write("c.txt", places(11, false));
  struct Choice {
    std::string name;
    int height;
    std::int64_t file;  ///< that has it
  };
  for (const Choice& choice :
       {Choice{"first", 5, 0}, {"lowest", 2, 1}, {"highest", 11, 2}, {"mean", 6, 0}}) {
    const auto stats = spill("a.txt b.txt c.txt -o mesh.npy --id --heights " + choice.name);
    EXPECT_EQ(stats["duplicates"], 2 * kPlaces);
    const auto vertices = array_of<double>(work_.read("mesh_vertices.npy"));
    const auto index = array_of<std::int64_t>(work_.read("mesh_input_index.npy"));
    ASSERT_EQ(index.size(), kPlaces);
    ASSERT_EQ(vertices.size(), 3 * index.size());
    int wrong = 0;
    for (std::size_t v = 0; v < index.size(); ++v) {
      const auto place = static_cast<std::int64_t>(vertices[3 * v + 1]);
      const std::int64_t in_file = choice.file == 1 ? kPlaces - 1 - place : place;
      const double height = choice.height + 20 * (place % 50);
      if (vertices[3 * v + 2] != height || index[v] != choice.file * kPlaces + in_file) ++wrong;
    }
    EXPECT_EQ(wrong, 0) << choice.name;
  }
}

constexpr std::size_t kLasHeader = 227;
constexpr std::size_t kLasScales = 131;
constexpr std::size_t kLasOffsets = 155;
constexpr std::size_t kLasRecord = 20;

double double_at(const std::string& bytes, std::size_t place) {
  double value = 0;
  std::memcpy(&value, bytes.data() + place, sizeof value);
  return value;
}

/// Coordinate `axis` of a record of a LAS file as `generate` makes it.
double las_coordinate(const std::string& las, std::size_t record, std::size_t axis) {
  std::int32_t integer = 0;
  std::memcpy(&integer, las.data() + kLasHeader + record * kLasRecord + 4 * axis, sizeof integer);
  return integer * double_at(las, kLasScales + 8 * axis) + double_at(las, kLasOffsets + 8 * axis);
}

TEST_F(OutOfCore, InputsOfOneLatticeWithOtherOffsetsAndHeightScalesKeepTheirCoordinates) {
  constexpr int kEach = 400'000;
  generate(kEach, "a.las");
  generate(kEach, "b.las", 2);
  std::string b = work_.read("b.las");
  const std::array<double, 3> offsets = {500'123.25, 4'100'040.5, -7};
  const double z_scale = 0.001;
  std::memcpy(b.data() + kLasScales + 16, &z_scale, sizeof z_scale);
  std::memcpy(b.data() + kLasOffsets, offsets.data(), sizeof offsets);
  work_.write("b.las", b);
  const auto stats = spill("a.las b.las -o mesh.npy --id");
  EXPECT_EQ(stats["on_lattice"], true);
  const std::string a = work_.read("a.las");
  const auto vertices = array_of<double>(work_.read("mesh_vertices.npy"));
  const auto index = array_of<std::int64_t>(work_.read("mesh_input_index.npy"));
  double largest_error = 0;
  for (std::size_t v = 0; v < index.size(); ++v) {
    const auto record = static_cast<std::size_t>(index[v]);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double expected = record < kEach ? las_coordinate(a, record, axis)
                                             : las_coordinate(b, record - kEach, axis);
      largest_error = std::max(largest_error, std::abs(vertices[3 * v + axis] - expected));
    }
  }
  EXPECT_LT(largest_error, 1e-8);
  EXPECT_EQ(check("mesh.npy --points a.las b.las")["canonical_hash"], stats["canonical_hash"]);
  EXPECT_EQ(spill("a.las b.las -o mesh.spm --threads 1")["canonical_hash"],
            stats["canonical_hash"]);
  EXPECT_EQ(check("mesh.spm --points a.las b.las")["on_lattice"], true);
}

TEST_F(OutOfCore, MaxEdgeLeavesOutTheSameInTilesAndInOne) {
  generate(50'000, "in.las");
  const auto whole = triangulate("in.las -o whole.ply --max-edge 1");
  const auto tiles = triangulate("in.las -o tiles.ply --max-edge 1 --tile-points 3000");
  EXPECT_GT(whole["left_out"], 0);
  for (const char* key : {"canonical_hash", "left_out", "simplices", "hull_facets"}) {
    EXPECT_EQ(tiles[key], whole[key]) << key;
  }
}

TEST_F(OutOfCore, ProgressOfAChainNamesEveryPhase) {
  const Result plain = work_.run(
      "spillway generate terrain -n 20000 | spillway triangulate - -o - | spillway check -");
  EXPECT_EQ(plain.exit_code, 0) << plain.err;
  for (const char* phase : {"generate", "read", "triangulate", "write", "check"}) {
    EXPECT_THAT(plain.err, HasSubstr(fmt::format("spillway: {}: ", phase)));
  }
  const Result json = work_.run(
      "spillway generate -q terrain -n 20000 | spillway triangulate --progress json - -o - | "
      "spillway info --progress json --json -");
  std::istringstream lines(json.err);
  int count = 0;
  for (std::string line; std::getline(lines, line); ++count) {
    EXPECT_TRUE(nlohmann::json::parse(line, nullptr, false).is_object()) << line;
  }
  EXPECT_GT(count, 3);
  const Result quiet = work_.run(
      "spillway generate -q terrain -n 20000 | spillway triangulate -q - -o - | "
      "spillway check -q - > report");
  EXPECT_EQ(quiet.out + quiet.err, "");
}

}  // namespace
}  // namespace spillway::test
