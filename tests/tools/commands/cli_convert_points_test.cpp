// `convert` of points: every format to every other, what LAS holds besides coordinates, rounding,
// pipes and filters.

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <sstream>
#include <string>
#include <vector>

#include "tests/tools/command_runner.h"
#include "tests/tools/inputs/las_samples.h"

namespace spillway::test {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

const std::vector<std::string> kFormats = {"las", "xyz", "csv", "npy", "ply", "spp"};

TEST(ConvertPoints, KeepsLatticePointsWhateverTheFormats) {
  const Workspace work;
  work.succeed(
      "spillway generate -q terrain -n 3000 -o in.las\n"
      "spillway convert -q in.las -o in.npy --attributes none");
  for (const std::string& there : kFormats) {
    work.succeed(fmt::format("spillway convert -q in.las -o there.{}", there));
    for (const std::string& back : kFormats) {
      // Text has decimals, so its doubles may differ in the last bit: the lattice takes them back.
      work.succeed(fmt::format(
          "spillway convert -q there.{} -o back.{} --scale 0.01 --offset 500000,4100000,0\n"
          "spillway convert -q back.{} -o back.las --scale 0.01 --offset 500000,4100000,0\n"
          "spillway convert -q back.las -o back.npy --attributes none\n"
          "cmp in.npy back.npy",
          there, back, back));
    }
  }
}

TEST(ConvertPoints, KeepsEveryBitOfDoubles) {
  const Workspace work;
  work.succeed("spillway generate -q uniform --dim 3 -n 3000 -o in.npy");
  for (const std::string format : {"xyz", "csv", "npy", "ply", "spp"}) {
    work.succeed(
        fmt::format("spillway convert -q in.npy -o there.{0}\n"
                    "spillway convert -q there.{0} -o back.npy\n"
                    "cmp in.npy back.npy",
                    format));
  }
}

TEST(ConvertPoints, KeepsTwoColumns) {
  const Workspace work;
  work.write("in.txt", "1 2.5\n-3 4\n");
  for (const std::string format : {"npy", "spp", "csv", "ply"}) {
    work.succeed(
        fmt::format("spillway convert -q in.txt -o there.{0}\n"
                    "spillway convert -q there.{0} -o back.txt\n"
                    "cmp in.txt back.txt",
                    format));
  }
  const Result las = work.run("spillway convert in.txt -o flat.las --scale 0.5");
  EXPECT_THAT(las.err, HasSubstr("no z: in LAS it is 0"));
  EXPECT_EQ(work.succeed("spillway convert -q flat.las -o - --output-format text"),
            "1 2.5 0\n-3 4 0\n");
}

/// A LAS 1.2 file of one point of class 2, the second return of three, withheld.
std::string las_of_one_point() {
  std::string las(247, '\0');
  const auto put = [&](std::size_t at, const auto& value) {
    las.replace(at, sizeof(value), reinterpret_cast<const char*>(&value), sizeof(value));
  };
  las.replace(0, 4, "LASF");
  put(24, std::uint8_t{1});
  put(25, std::uint8_t{2});
  put(94, std::uint16_t{227});
  put(96, std::uint32_t{227});
  put(105, std::uint16_t{20});
  put(107, std::uint32_t{1});
  for (std::size_t axis = 0; axis < 3; ++axis) put(131 + 8 * axis, 0.01);
  put(227 + 12, std::uint16_t{77});  // intensity
  put(227 + 14, std::uint8_t{2 | (3 << 3)});
  put(227 + 15, std::uint8_t{2 | 0x80});
  return las;
}

TEST(ConvertPoints, KeepsAttributesAndTellsWhatItDrops) {
  const Workspace work;
  work.write("in.las", las_of_one_point());
  const Result there = work.run(
      "spillway convert in.las -o there.las --keep-withheld "
      "--las-version 1.4");
  EXPECT_EQ(there.exit_code, 0) << there.err;
  EXPECT_THAT(there.err, AllOf(Not(HasSubstr("not kept")), Not(HasSubstr("rounded"))));
  EXPECT_EQ(work.info("there.las")["version"], "1.4");
  EXPECT_EQ(work.read("there.las").substr(375 + 14, 3), "\x32\x04\x02");
  work.succeed("spillway convert -q there.las -o back.las --keep-withheld --las-version 1.2");
  EXPECT_EQ(work.read("back.las").substr(227 + 14, 2), "\x1a\x82");
  EXPECT_THAT(
      work.run("spillway convert in.las -o out.xyz --keep-withheld").err,
      HasSubstr("not kept: intensity, return_number, number_of_returns, scan_direction, "
                "edge_of_flight_line, classification, synthetic, key_point, withheld, scan_angle, "
                "user_data, point_source_id\n"));
  EXPECT_THAT(work.run("spillway convert -q in.las -o out.xyz --keep-withheld").err, "");
  EXPECT_THAT(work.run("spillway convert in.las -o out.xyz").err, HasSubstr("1 withheld"));
}

/// A LAS 1.4 file of that point format, with extra bytes in its records.
std::string las_of_format(int point_format, std::size_t extra_bytes) {
  LasFile las = scattered_las(0, 5);
  las.minor = 4;
  las.point_format = point_format;
  las.extra_bytes = extra_bytes;
  return las.bytes();
}

TEST(ConvertPoints, TellsWhatTheInputAtHandHas) {
  const Workspace work;
  const std::string old = ", withheld, scan_angle, user_data, point_source_id";
  const std::string extended =
      ", scanner_channel, scan_direction, edge_of_flight_line, classification, user_data, "
      "scan_angle, point_source_id, gps_time";
  const std::string waves =
      ", wave_packet_descriptor, wave_packet_offset, wave_packet_size, wave_packet_location, "
      "wave_packet_dx, wave_packet_dy, wave_packet_dz";
  const std::string colour = ", red, green, blue";
  const std::vector<std::string> ends = {old,
                                         old + ", gps_time",
                                         old + colour,
                                         old + ", gps_time" + colour,
                                         old + ", gps_time" + waves,
                                         old + ", gps_time" + colour + waves,
                                         extended,
                                         extended + colour,
                                         extended + colour + ", nir",
                                         extended + waves,
                                         extended + colour + ", nir" + waves};
  for (int format = 0; format <= 10; ++format) {
    for (const std::size_t extra : {std::size_t{0}, std::size_t{3}}) {
      work.write("in.las", las_of_format(format, extra));
      EXPECT_THAT(work.run("spillway convert in.las -o out.xyz").err,
                  AllOf(HasSubstr("not kept: intensity, return_number, number_of_returns, "),
                        HasSubstr(ends[format] + (extra > 0 ? ", extra_bytes\n" : "\n"))));
      EXPECT_THAT(work.run("spillway convert in.las -o out.las").err, Not(HasSubstr("not kept")));
    }
  }
  work.write("a.las", las_of_format(1, 0));
  work.write("b.las", las_of_format(2, 0));
  EXPECT_THAT(work.run("spillway convert a.las b.las -o out.xyz").err,
              HasSubstr(old + ", gps_time" + colour + "\n"));
  EXPECT_THAT(work.run("spillway convert a.las b.las -o out.las").err, Not(HasSubstr("not kept")));
  EXPECT_EQ(work.info("out.las")["point_format"], 3) << "the least that holds both";
}

TEST(ConvertPoints, TextNpyAndSppHaveNothingToLose) {
  const Workspace work;
  work.write("in.txt", "1 2 3\n4 5 6\n7 9 9\n");
  work.succeed("spillway convert -q in.txt -o in.npy; spillway convert -q in.txt -o in.spp");
  for (const char* const input : {"in.txt", "in.npy", "in.spp"}) {
    EXPECT_THAT(work.run(std::string("spillway convert ") + input + " -o out.las").err,
                Not(HasSubstr("not kept")));
  }
}

TEST(ConvertPoints, ChoosesVersion14ForItsPointFormats) {
  const Workspace work;
  work.succeed(
      "spillway generate -q terrain -n 100 -o old.las\n"
      "spillway generate -q terrain -n 100 -o new.las --las-version 1.4\n"
      "spillway convert -q old.las -o from_old.las\n"
      "spillway convert -q new.las -o from_new.las");
  EXPECT_EQ(work.info("from_old.las")["version"], "1.2");
  EXPECT_EQ(work.info("from_new.las")["version"], "1.4");
}

TEST(ConvertPoints, TellsHowFarRoundingMovedCoordinates) {
  const Workspace work;
  work.write("in.txt", "500000.1234 4000000.5678 10.00049\n500001 4000001 11\n");
  const Result automatic = work.run("spillway convert in.txt -o out.las");
  EXPECT_EQ(automatic.exit_code, 0);
  EXPECT_THAT(automatic.err, AllOf(HasSubstr("rounded to multiples of 0.001 from 0, 4000000, 0 on"),
                                   HasSubstr("moved them by 0.00049 at most")));
  work.succeed("spillway convert -q in.txt -o out.las --scale 0.01,0.01,0.1 --offset 500000,4e6,0");
  EXPECT_EQ(work.succeed("spillway convert -q out.las -o - --output-format text"),
            "500000.12 4000000.57 10.0\n500001.00 4000001.00 11.0\n");
  EXPECT_EQ(work.run("spillway convert -q in.txt -o out.las --scale 0").exit_code, 2);
  EXPECT_EQ(work.run("spillway convert -q in.txt -o out.las --scale 1,2").exit_code, 2);
}

TEST(ConvertPoints, ChoosesAFineScaleForDegrees) {
  const Workspace work;
  work.write("in.txt", "-81.1234567 28.7654321 12.5\n");
  work.succeed("spillway convert -q in.txt -o out.las");
  EXPECT_EQ(work.succeed("spillway convert -q out.las -o - --output-format text"),
            "-81.1234567 28.7654321 12.500\n");
}

TEST(ConvertPoints, NamesThePointThatIntegersDoNotReach) {
  const Workspace work;
  work.write("in.txt", "1 2 3\n4 5 6\n1 1e7 3\n");
  const Result result = work.run("spillway convert in.txt -o out.las --scale 0.001 --offset 0");
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_THAT(result.err, AllOf(HasSubstr("cannot write out.las: point 2 is at (1, 10000000, 3)"),
                                HasSubstr("choose another --scale or --offset")));
  EXPECT_EQ(work.names(), std::vector<std::string>{"in.txt"});
}

TEST(ConvertPoints, GivesAPipeWhatAFileWouldHold) {
  const Workspace work;
  work.succeed(
      "spillway generate -q terrain -n 100000 -o in.las\n"
      "spillway convert -q in.las -o out.npy --attributes none\n"
      "spillway convert -q in.las -o out.las --attributes none");
  for (const std::string format : {"npy", "las"}) {
    work.succeed(fmt::format(
        "spillway convert -q - -o - --output-format {0} --attributes none < in.las > "
        "piped.{0}\n"
        "cmp out.{0} piped.{0}\n"
        "cat in.las | spillway convert -q - -o - --scratch-folder . | "
        "spillway convert -q - -o - --output-format {0} --attributes none --scratch-folder . "
        "| cat > piped.{0}",
        format));
  }
  work.succeed(
      "cmp out.npy piped.npy\n"
      "spillway convert -q piped.las -o again.npy --attributes none\n"
      "cmp out.npy again.npy");
  EXPECT_EQ(work.info("piped.las")["extent"], work.info("in.las")["extent"]);
  EXPECT_EQ(work.names(), (std::vector<std::string>{"again.npy", "in.las", "out.las", "out.npy",
                                                    "piped.las", "piped.npy"}));
}

TEST(ConvertPoints, JoinsAndFiltersInputs) {
  const Workspace work;
  work.write("a.txt", "1 2 3\n4 5 6\n");
  work.write("b.csv", "7,8,9\n10,11,12\n");
  EXPECT_EQ(work.succeed("spillway convert -q a.txt b.csv -o - --output-format text"),
            "1 2 3\n4 5 6\n7 8 9\n10 11 12\n");
  EXPECT_EQ(work.succeed("spillway convert -q '?.*' -o - --output-format text --bounds 2,2,8,8"),
            "4 5 6\n7 8 9\n");
  work.succeed("spillway convert -q a.txt b.csv -o all.las --scale 1 --every 2");
  EXPECT_EQ(work.info("all.las")["points"], 2);
}

TEST(ConvertPoints, KeepsTheCoordinateSystem) {
  const std::string sample = shared_file("autzen_trim.las").string();
  if (sample.empty()) GTEST_SKIP() << "no sample data";
  const Workspace work;
  work.succeed(
      fmt::format("spillway convert -q '{}' -o out.las --keep-withheld\n"
                  "spillway convert -q '{}' -o out.npy --keep-withheld\n"
                  "spillway convert -q out.las -o back.npy --keep-withheld\n"
                  "cmp out.npy back.npy\n"
                  "spillway convert -q out.las -o later.las --las-version 1.4",
                  sample, sample));
  const auto crs = nlohmann::json::parse(
      work.succeed(fmt::format("spillway info -q --json '{}'", sample)))["crs"];
  EXPECT_EQ(work.info("out.las")["crs"], crs);
  EXPECT_FALSE(work.info("later.las")["crs"].is_null());
  EXPECT_THAT(work.run(fmt::format("spillway convert '{}' -o out.xyz", sample)).err,
              AllOf(HasSubstr("gps_time, red, green, blue, "), HasSubstr(", coordinate system\n")));
}

TEST(ConvertPoints, TakesAttributesToTextAndBack) {
  const Workspace work;
  work.write("in.las", las_of_format(7, 3));
  work.succeed("spillway convert -q in.las -o all.csv --keep-withheld");
  EXPECT_THAT(work.read("all.csv"),
              ::testing::StartsWith("x,y,z,intensity,return_number,number_of_returns,synthetic,"));
  work.succeed("spillway convert -q all.csv -o back.las --scale 0.01");
  work.succeed("spillway convert -q back.las -o back.csv --keep-withheld");
  EXPECT_EQ(work.info("back.las")["point_format"], 7);
  EXPECT_EQ(work.read("back.csv"), work.read("all.csv"));

  work.succeed("spillway convert -q in.las -o some.csv --attributes Class,GpsTime");
  EXPECT_THAT(work.read("some.csv"), ::testing::StartsWith("x,y,z,classification,gps_time\n"));
  work.succeed("spillway convert -q in.las -o none.csv --attributes none");
  EXPECT_EQ(work.read("none.csv").find('x'), std::string::npos);
  work.succeed("spillway convert -q in.las -o all.xyz --attributes all");
  EXPECT_THAT(work.read("all.xyz"), ::testing::StartsWith("x y z intensity "));
  const Result unknown = work.run("spillway convert in.las -o x.csv --attributes intensity,colour");
  EXPECT_EQ(unknown.exit_code, 2);
  EXPECT_THAT(unknown.err, HasSubstr("the points have no attribute \"colour\": choose of "
                                     "intensity, return_number, "));
  EXPECT_TRUE(work.run("test -e x.csv").exit_code != 0);
}

TEST(ConvertPoints, ReplacesAnInputByWhatHoldsLessOnlyIfThatIsMeant) {
  const Workspace work;
  const std::string las = las_of_format(3, 0);
  work.write("in.las", las);
  for (const std::string options : {"--every 2", "--attributes class", "--scale 0.5"}) {
    const Result refused = work.run("spillway convert in.las -o ./in.las " + options);
    EXPECT_EQ(refused.exit_code, 2) << options;
    EXPECT_THAT(refused.err, HasSubstr("in.las is an input, and would lose "));
    EXPECT_THAT(refused.err, HasSubstr("choose another name, or add --force"));
    EXPECT_EQ(work.read("in.las"), las);
    work.succeed("spillway convert -q in.las -o in.las --force " + options);
    EXPECT_NE(work.read("in.las"), las);
    work.write("in.las", las);
  }
  work.succeed("spillway convert -q in.las -o in.las --keep-withheld");
  EXPECT_EQ(work.info("in.las")["points"], 5);
}

TEST(ConvertPoints, KeepsPointsOfWhichAConditionHolds) {
  const Workspace work;
  work.write("in.csv", "x,y,z,intensity,class\n1,2,3,100,2\n4,5,6,300,2\n7,8,9,300,5\n");
  work.succeed(
      "spillway convert -q in.csv -o out.csv --where 'intensity > 200 and class in (2, 9)'");
  EXPECT_EQ(work.read("out.csv"), "x,y,z,intensity,classification\n4,5,6,300,2\n");
  // The filter looks at others than those that are written.
  work.succeed(
      "spillway convert -q in.csv -o some.csv --attributes class --where 'intensity > 200'");
  EXPECT_EQ(work.read("some.csv"), "x,y,z,classification\n4,5,6,2\n7,8,9,5\n");
  work.succeed("spillway convert -q in.csv -o thin.csv --attributes class --thin 1 --keep-class 5");
  EXPECT_EQ(work.read("thin.csv"), "x,y,z,classification\n7,8,9,5\n");
  EXPECT_THAT(work.run("spillway convert in.csv -o out.csv --where 'x > 3 and not class = 5'").err,
              HasSubstr("3 points read, 2 for which the condition does not hold, 1 kept"));
  const Result missing = work.run("spillway convert in.csv -o out.csv --where 'red > 3'");
  EXPECT_EQ(missing.exit_code, 1);
  EXPECT_THAT(missing.err,
              HasSubstr("in.csv: the points have no red, which a filter looks at; they "
                        "have intensity, classification; leave out that filter"));
  EXPECT_EQ(work.run("spillway triangulate in.csv -o t.ply --where 'z >'").exit_code, 2);
  work.succeed("spillway generate -q terrain -n 20000 -o all.las");
  work.succeed(
      "spillway triangulate -q all.las -o a.spm --where 'y < 500 or z > 40'\n"
      "spillway convert -q all.las -o part.las --where 'y < 500 or z > 40'\n"
      "spillway triangulate -q part.las -o b.spm");
  EXPECT_EQ(work.info("a.spm")["canonical_hash"], work.info("b.spm")["canonical_hash"]);
}

TEST(ConvertPoints, TakesAttributesThroughPipesFiltersAndThinning) {
  const Workspace work;
  work.write("in.las", las_of_format(3, 0));
  const std::string keep = " --keep-withheld -q ";
  work.succeed("spillway convert in.las -o all.csv" + keep);
  work.succeed("cat in.las | spillway convert - -o - --output-format laz" + keep +
               "| spillway convert - -o pipe.csv" + keep);
  EXPECT_EQ(work.read("pipe.csv"), work.read("all.csv"));
  work.succeed("spillway convert in.las -o thin.csv --thin 0.0001" + keep);
  EXPECT_EQ(work.read("thin.csv"), work.read("all.csv"));
  work.succeed("spillway convert in.las -o every.csv --every 2" + keep);
  std::istringstream all(work.read("all.csv"));
  std::string expected;
  std::string line;
  for (int row = 0; std::getline(all, line); ++row) {
    if (row == 0 || row % 2 == 1) expected += line + "\n";
  }
  EXPECT_EQ(work.read("every.csv"), expected);
}

/// Real files, of which each format that holds attributes gives back all of them.
class SharedAttributes : public ::testing::TestWithParam<std::string> {};

INSTANTIATE_TEST_SUITE_P(Files, SharedAttributes,
                         ::testing::Values("1.2-with-color.las", "1.2-with-color.copc.laz",
                                           "4_6_crop.las", "Megaplot.laz", "MixedConifer.laz",
                                           "Topography.laz", "autzen_trim.las", "autzen_trim.laz",
                                           "autzen_trim_7.las", "certainty3d.las", "crop.laz",
                                           "crop_1.laz", "crop_2.laz", "hexbin-crop.las",
                                           "las_with_several_extra_byte_bloc.laz",
                                           "lone-star.copc.laz", "lone-star.laz", "mvk-thin.las",
                                           "rand1_6.las", "sample_nc.las",
                                           "simple-laszip-compressor-version-1.2r0.laz"),
                         [](const auto& tested) {
                           std::string name = tested.param;
                           std::ranges::replace_if(
                               name, [](unsigned char c) { return std::isalnum(c) == 0; }, '_');
                           return name;
                         });

std::vector<std::string> sorted_lines(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  std::ranges::sort(lines);
  return lines;
}

TEST_P(SharedAttributes, GoThroughEveryFormatAndBack) {
  const std::string file = shared_file(GetParam()).string();
  if (file.empty()) GTEST_SKIP() << "the shared sample data is not there";
  const Workspace work;
  work.succeed(
      fmt::format("spillway convert -q '{}' -o in.las --keep-withheld\n"
                  "spillway convert -q in.las -o in.csv --keep-withheld",
                  file));
  const auto info = work.info("in.las");
  const std::string version = info["point_format"] < 6 ? "1.2" : "1.4";
  const auto three = [&](const char* of) {
    const auto numbers = info[of].get<std::vector<double>>();
    return fmt::format("{}", fmt::join(numbers, ","));
  };
  for (const std::string format : {"las", "laz", "copc.laz", "csv", "npy", "ply", "spp"}) {
    work.succeed(fmt::format(
        "spillway convert -q in.las -o there.{0} --keep-withheld\n"
        "spillway convert -q there.{0} -o back.las --keep-withheld --las-version {1} --scale {2} "
        "--offset {3}\n"
        "spillway convert -q back.las -o back.csv --keep-withheld",
        format, version, three("scale"), three("offset")));
    if (format == "copc.laz") {  // it has the points in another order
      EXPECT_TRUE(sorted_lines(work.read("back.csv")) == sorted_lines(work.read("in.csv")));
      continue;
    }
    EXPECT_TRUE(work.read("back.csv") == work.read("in.csv")) << format;
    if (format == "las") {
      EXPECT_TRUE(work.read("there.las") == work.read("in.las"));
    }
  }
}

TEST(ConvertPoints, WritesLazAndReadsItBackAsTheSameLas) {
  const Workspace work;
  work.succeed("spillway generate -q terrain -n 120000 -o in.las");
  for (const std::string version : {"1.2", "1.4"}) {
    work.succeed("spillway convert -q in.las -o there.laz --las-version " + version);
    EXPECT_EQ(work.info("there.laz")["format"], "laz");
    EXPECT_EQ(work.info("there.laz")["version"], version);
    EXPECT_LT(work.read("there.laz").size(), work.read("in.las").size() / 4);
    work.succeed("spillway convert -q there.laz -o back.las --las-version 1.2 --attributes none");
    EXPECT_EQ(work.read("back.las"), work.read("in.las")) << version;
  }
}

TEST(ConvertPoints, WritesLazIntoAPipe) {
  const Workspace work;
  work.succeed(
      "spillway generate -q terrain -n 120000 -o in.las\n"
      "spillway generate -q terrain -n 120000 --output-format laz -o - > there.laz\n"
      "spillway convert -q there.laz -o file.las\n"
      "cat there.laz | spillway convert -q - -o pipe.las\n"
      "cat in.las | spillway convert -q - --output-format laz -o - > again.laz\n"
      "spillway convert -q again.laz -o again.las");
  for (const char* const name : {"file.las", "pipe.las", "again.las"}) {
    EXPECT_EQ(work.read(name), work.read("in.las")) << name;
  }
}

TEST(ConvertPoints, RefusesWhatItCannotDoAndLeavesNothing) {
  const Workspace work;
  work.write("in.txt", "1 2 3\n");
  const Result copc = work.run("spillway convert in.txt -o out.copc.laz --las-version 1.2");
  EXPECT_THAT(copc.err, HasSubstr("COPC is LAS 1.4"));
  EXPECT_EQ(copc.exit_code, 2);
  EXPECT_THAT(work.run("spillway convert in.txt -o out.obj").err, HasSubstr("these are points"));
  EXPECT_EQ(work.run("spillway convert in.txt -o out.dat").exit_code, 2);
  work.succeed("spillway generate -q uniform -n 9 | spillway triangulate -q - -o mesh.spm");
  EXPECT_EQ(work.run("spillway convert mesh.spm -o out.ply --every 2").exit_code, 2);
  EXPECT_EQ(work.run("spillway convert mesh.spm -o out.ply --scale 1").exit_code, 2);
  EXPECT_THAT(work.run("spillway convert -q in.txt -o /dev/full").err, HasSubstr("cannot tell"));
  EXPECT_THAT(work.run("spillway convert -q in.txt -o /dev/full --output-format las").err,
              HasSubstr("No space left on device"));
  EXPECT_EQ(work.names(), (std::vector<std::string>{"in.txt", "mesh.spm"}));
}

/// What `convert -v` says of its memory, in MiB.
double peak_memory(const Result& result) {
  const std::string label = "peak memory ";
  const std::size_t at = result.err.find(label);
  EXPECT_NE(at, std::string::npos) << result.err;
  return std::stod(result.err.substr(at + label.size())) / (1 << 20);
}

TEST(ConvertPoints, TakesNoMoreMemoryForMorePoints) {
  constexpr double kSlack = 24;  // what 3 million points would take is 70 MiB at least
  const Workspace work;
  work.succeed(
      "spillway generate -q terrain -n 2e5 -o few.spp\n"
      "spillway generate -q terrain -n 3e6 -o many.spp");
  for (const std::string step : {"spillway convert -v {0}.spp -o {0}.las",
                                 "spillway convert -v {0}.las -o - --output-format npy > {0}.npy",
                                 "spillway convert -v {0}.npy -o {0}.las"}) {
    const double few = peak_memory(work.run(fmt::format(fmt::runtime(step), "few")));
    EXPECT_LT(peak_memory(work.run(fmt::format(fmt::runtime(step), "many"))), few + kSlack) << step;
  }
  EXPECT_EQ(work.info("many.las")["points"], 3000000);
}

}  // namespace
}  // namespace spillway::test
