// Lattices whose numbers are too coarse for their scale, or beyond what numbers hold: said before
// work, for points, meshes and what convert writes; and those that just do are not refused.

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cstring>
#include <limits>
#include <string>
#include <vector>

#include "tests/tools/command_runner.h"
#include "tests/tools/inputs/las_samples.h"

namespace spillway::test {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

/// The bytes of a LAS file with the bounds that belong to its points.
std::string bytes_with_bounds(const LasFile& las) {
  std::array<double, 6> bounds{};
  for (std::size_t k = 0; k < 3; ++k) {
    bounds[2 * k] = -std::numeric_limits<double>::infinity();
    bounds[2 * k + 1] = std::numeric_limits<double>::infinity();
  }
  for (const LasFile::Record& record : las.records) {
    const std::array<double, 3> integers = {static_cast<double>(record.x),
                                            static_cast<double>(record.y),
                                            static_cast<double>(record.z)};
    for (std::size_t k = 0; k < 3; ++k) {
      const double world = integers[k] * las.scale[k] + las.offset[k];
      bounds[2 * k] = std::max(bounds[2 * k], world);
      bounds[2 * k + 1] = std::min(bounds[2 * k + 1], world);
    }
  }
  std::string bytes = las.bytes();
  std::memcpy(bytes.data() + 179, bounds.data(), sizeof(bounds));
  return bytes;
}

/// Points in a square of 10 units, with the bounds that belong to them.
std::string las_at(const std::array<double, 3>& scale, const std::array<double, 3>& offset) {
  LasFile las = scattered_las(0, 500);
  las.scale = scale;
  las.offset = offset;
  for (LasFile::Record& record : las.records) {
    record.x %= 1000;
    record.y %= 1000;
  }
  return bytes_with_bounds(las);
}

void expect_error(const Workspace& work, const std::string& command,
                  const ::testing::Matcher<std::string>& message) {
  const auto before = work.names();
  const Result result = work.run(command);
  EXPECT_EQ(result.exit_code, 1) << command;
  EXPECT_THAT(result.err, message) << command;
  EXPECT_EQ(work.names(), before) << command;
}

TEST(Lattices, WhoseOffsetSwampsTheirScaleAreRefusedWithTheirNumbers) {
  if (build_lacks("GDAL")) GTEST_SKIP() << kNoGdal;
  const Workspace work;
  work.write("a.las", las_at({.01, .01, .01}, {1e15, 4000000, 0}));
  work.write("b.las", las_at({.001, .001, .001}, {500000, 1e13, 0}));
  work.write("c.las", las_at({.01, .01, .01}, {-1e305, 0, 0}));
  for (const std::string command :
       {"triangulate -q {}.las -o out.spm", "dem -q {}.las --resolution 1 -o out.tif",
        "info -q {}.las", "convert -q {}.las -o out.spp", "triangulate -q - -o out.spm <{}.las",
        "triangulate -q {}.las --dim 3 -o out.spm"}) {
    const auto of = [&](const char* name) {
      return "spillway " + fmt::format(fmt::runtime(command), name);
    };
    expect_error(work, of("a"),
                 AllOf(HasSubstr("x is an integer times 0.01 plus 1000000000000000"),
                       HasSubstr("0.125 apart"), HasSubstr("larger scale")));
    expect_error(work, of("b"), HasSubstr("y is an integer times 0.001 plus 10000000000000"));
    expect_error(work, of("c"), HasSubstr("x is an integer times 0.01 plus -1e+305"));
  }
}

TEST(Lattices, OfHeightsOnlyHaveToBeFiniteInThePlane) {
  const Workspace work;
  work.write("a.las", las_at({.01, .01, .01}, {500000, 4000000, 1e15}));
  work.succeed("spillway triangulate -q a.las -o out.spm && spillway check -q out.spm");
  expect_error(work, "spillway triangulate -q a.las --dim 3 -o b.spm",
               HasSubstr("z is an integer times 0.01 plus 1000000000000000"));
}

TEST(Lattices, ThatKeepPointsApartAreFine) {
  const Workspace work;
  work.write("a.las", las_at({.01, .01, .01}, {1e13, -1e13, 0}));
  work.write("b.las", las_at({.125, .125, .125}, {1e15, 1e15, 0}));   // exact
  work.write("c.las", las_at({1, 1, 1}, {4503599627370496., 0, 0}));  // likewise, at 2^52
  work.write("d.las", las_at({1e-7, 1e-7, .001}, {-77, 38, 0}));      // degrees
  work.write("e.las", las_at({1e200, 1e200, 1e200}, {0, 0, 0}));
  for (const char* const name : {"a", "b", "c", "d", "e"}) {
    work.succeed(
        fmt::format("spillway triangulate -q {0}.las -o {0}.spm\n"
                    "spillway check -q {0}.spm --points {0}.las\n"
                    "spillway convert -q {0}.las -o {0}.spp\n"
                    "spillway triangulate -q {0}.spp -o {0}.ply\n"
                    "spillway check -q {0}.ply --points {0}.las",
                    name));
  }
}

TEST(Lattices, OfStreamsAreLookedAtPointByPoint) {
  // The header of the stream tells no extent, and what a pipe of LAS tells may be wide or false.
  const Workspace work;
  work.write("a.las", las_at({.01, .01, .01}, {500000, 4000000, 0}));
  work.succeed("spillway convert -q a.las -o a.spp");
  work.succeed("spillway generate -q terrain -n 1000 | spillway triangulate -q - -o b.spm");
  std::string lying = las_at({.01, .01, .01}, {1e15, 4000000, 0});
  const double zero = 0;
  for (std::size_t k = 0; k < 6; ++k) std::memcpy(lying.data() + 179 + 8 * k, &zero, 8);
  work.write("lying.las", lying);
  expect_error(work, "spillway triangulate -q lying.las -o out.spm",
               HasSubstr("x is an integer times 0.01"));
}

TEST(Lattices, OfPointsThatAFilterDropsDoNotMatter) {
  // Up to 2^46 the step of numbers is below the scale, and beyond it is above: only the last record
  // lies there, of a class of its own.
  const Workspace work;
  LasFile las = scattered_las(0, 500);
  for (LasFile::Record& record : las.records) {
    record.x %= 1000;
    record.y %= 1000;
  }
  las.offset = {0x1p46 - 1e6, 0, 0};
  LasFlags corrupt;
  corrupt.classification = 7;
  las.records.push_back({2'000'000'000, 5, 5, false, corrupt});
  work.write("told.las", bytes_with_bounds(las));
  las.records.back().y = 6;  // and the header has other bounds
  work.write("untold.las", las.bytes());
  for (const std::string name : {"told", "untold"}) {
    expect_error(work, "spillway triangulate -q " + name + ".las -o out.spm",
                 HasSubstr("x is an integer times 0.01"));
    for (const std::string filter : {"--drop-class 7", "--bounds 0,0,70368743177764,10"}) {
      const std::string options = name + ".las " + filter;
      work.succeed("spillway triangulate -q -o out.spm " + options +
                   "\nspillway check -q out.spm --points " + options +
                   "\nspillway triangulate -q -o out.spm told.las " + options +
                   "\nspillway convert -q -o out.txt --thin 1 " + options + "\nrm out.*");
    }
    expect_error(work, "spillway triangulate -q --drop-class 3 -o out.spm " + name + ".las",
                 HasSubstr("x is an integer times 0.01"));
  }
}

TEST(Lattices, OfSeveralInputsFallBackToOutputCoordinates) {
  const Workspace work;
  // Each keeps its own points apart, and their common lattice would not.
  work.write("fine.las", las_at({.0001, .0001, .0001}, {0, 0, 0}));
  work.write("far.las", las_at({.01, .01, .01}, {4e12, 4e12, 0}));
  const Result result = work.run("spillway triangulate -v fine.las far.las -o out.spm");
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(result.err, HasSubstr("output coordinates"));
  work.succeed("spillway check -q out.spm --points fine.las far.las");
}

TEST(Lattices, InCommonThatDoNotKeepPointsApartAreToldSo) {
  // Numbers are 0.00195 apart there, which is below both scales but above their common step.
  const Workspace work;
  work.write("a.las", las_at({.003, .003, .003}, {1e13, 0, 0}));
  work.write("b.las", las_at({.004, .004, .004}, {1e13, 0, 0}));
  const Result result = work.run("spillway triangulate -v a.las b.las -o out.spm");
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(result.err, HasSubstr("a.las: the common lattice of all inputs, of step 0.001, does "
                                    "not keep its points apart, so points come in output "
                                    "coordinates"));
  EXPECT_THAT(result.err, Not(HasSubstr("no lattice has all inputs")));
}

TEST(Lattices, ThatConvertIsToWriteAreChecked) {
  const Workspace work;
  work.write("a.txt", "1e13 0 1\n10000000000001 0 2\n1e13 1 3\n");
  expect_error(work, "spillway convert -q a.txt -o out.las",
               AllOf(HasSubstr("cannot write out.las"), HasSubstr("--scale")));
  expect_error(work, "spillway convert -q a.txt -o out.spp --scale 0.001 --offset 1e13,0,0",
               HasSubstr("x is an integer times 0.001"));
  work.succeed("spillway convert -q a.txt -o out.las --scale 0.5 --offset 1e13,0,0");
}

TEST(Lattices, OfMeshesAreChecked) {
  if (build_lacks("GDAL")) GTEST_SKIP() << kNoGdal;
  const Workspace work;
  const std::string notes =
      "# spillway dimension 2\n# spillway lattice 0.01 0.01 0.01 1000000000000000 0 0\n";
  const std::string v = "v 1000000000000000 0 1\nv 1000000000000001 0 2\nv 1000000000000000 1 3\n";
  work.write("m.obj", notes + v + "f 1 2 3\n");
  work.write("m.sma", notes + v + "f 1 2 3\nx 1\nx 2\nx 3\n");
  for (const std::string mesh : {"m.obj", "m.sma"}) {
    for (const std::string& command :
         {"info -q " + mesh, "check -q " + mesh, "dem -q " + mesh + " --resolution 1 -o out.tif",
          "contour -q " + mesh + " --interval 1 --force-crs -o out.geojson",
          "convert -q " + mesh + " -o out.ply"}) {
      expect_error(work, "spillway " + command,
                   AllOf(HasSubstr(mesh), HasSubstr("x is an integer times 0.01")));
    }
  }
}

}  // namespace
}  // namespace spillway::test
