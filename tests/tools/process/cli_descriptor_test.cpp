// Standard input, output and error that are closed when the command starts: no file gets their
// numbers, and what is to be read or written there is an error.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <string>

#include "tests/tools/command_runner.h"

namespace spillway::test {
namespace {

using ::testing::HasSubstr;

/// All combinations, as a shell writes them.
constexpr std::array kClosed = {"",        "<&-",      ">&-",      "2>&-",
                                "<&- >&-", "<&- 2>&-", ">&- 2>&-", "<&- >&- 2>&-"};

TEST(ClosedDescriptors, GetIntoNoOutput) {
  const Workspace work;
  work.succeed("spillway generate -q terrain -n 3000 -o in.las");
  for (const std::string name : {"a.ply", "a.spm", "a.sma", "a.vtu", "a.npy", "a.stl", "a.obj"}) {
    const std::string found = name == "a.npy" ? "a_simplices.npy" : name;
    work.succeed("spillway triangulate in.las -o " + name + " 2> /dev/null; cp " + found +
                 " whole");
    const std::string whole = work.read("whole");
    for (const std::string closed : kClosed) {
      work.succeed("rm " + found + "; spillway triangulate in.las -o " + name + " " + closed);
      EXPECT_TRUE(work.read(found) == whole) << name << " with " << closed;
    }
  }
}

TEST(ClosedDescriptors, GetIntoNoOutputOfOtherSubcommands) {
  if (build_lacks("GDAL")) GTEST_SKIP() << kNoGdal;
  const Workspace work;
  work.succeed("spillway generate -q terrain -n 3000 -o in.las");
  const std::string commands =
      "spillway convert in.las -o points.txt CLOSED && "
      "spillway contour in.las --interval 20 -o lines.geojson --force-crs CLOSED && "
      "spillway dem in.las --resolution 20 -o dem.tif --stats stats.json CLOSED && "
      "spillway batch in.las --output-dir out --to ply CLOSED";
  const auto results = [&](const std::string& closed) {
    std::string script = commands;
    for (std::size_t at = 0; (at = script.find("CLOSED")) != std::string::npos;) {
      script.replace(at, 6, closed);
    }
    work.succeed("rm -rf points.txt lines.geojson dem.tif out; { " + script + "; } 2> /dev/null");
    EXPECT_TRUE(nlohmann::json::accept(work.read("stats.json"))) << closed;
    return work.succeed("cat points.txt lines.geojson dem.tif out/in.ply | cksum");
  };
  const std::string whole = results("");
  for (const std::string closed : kClosed) EXPECT_EQ(results(closed), whole) << closed;
}

TEST(ClosedDescriptors, AreErrorsWhereTheyAreWanted) {
  const Workspace work;
  work.write("in.txt", "0 0 0\n1 0 0\n0 1 0\n");
  for (const std::string closed : kClosed) {
    const bool no_input = closed.find('<') != std::string::npos;
    const bool no_output = closed.find(">&- ") != std::string::npos || closed.ends_with(" >&-") ||
                           closed == ">&-" || closed == "<&- >&- 2>&-";
    const bool no_error = closed.find("2>&-") != std::string::npos;
    const Result read = work.run("cat in.txt | spillway triangulate -q - -o mesh.ply " + closed);
    EXPECT_EQ(read.exit_code, no_input ? 1 : 0) << closed;
    EXPECT_EQ(work.has("mesh.ply"), !no_input) << closed;
    if (no_input && !no_error) {
      EXPECT_THAT(read.err, HasSubstr("cannot read standard input: it is closed")) << closed;
    }
    work.succeed("rm -f mesh.ply");
    for (const std::string command : {"triangulate in.txt -o -", "info in.txt", "--help"}) {
      const Result written = work.run("spillway " + command + " " + closed);
      EXPECT_EQ(written.exit_code, no_output ? 1 : 0) << command << closed;
      if (no_output && !no_error) {
        EXPECT_THAT(written.err, HasSubstr("cannot write standard output: it is closed")) << closed;
      }
    }
  }
}

}  // namespace
}  // namespace spillway::test
