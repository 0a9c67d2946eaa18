// Options that would have no effect are refused, with words that say why, before any work.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "tests/tools/command_runner.h"

namespace spillway::test {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;

struct Unused {
  const char* name;
  const char* arguments;
  const char* message;
};

void PrintTo(const Unused& unused, std::ostream* stream) { *stream << unused.arguments; }

/// Points in.las, in 3D space.npy and without heights flat.txt; meshes of these.
void make_inputs(const Workspace& work) {
  work.succeed(
      "spillway generate -q terrain -n 500 -o in.las\n"
      "spillway generate -q uniform --dim 3 -n 50 -o space.npy\n"
      "spillway generate -q uniform -n 50 -o flat.txt\n"
      "spillway triangulate -q in.las -o tin.ply\n"
      "spillway triangulate -q in.las -o tin.spm\n"
      "spillway triangulate -q space.npy --dim 3 -o space.vtu\n"
      "mkdir folder && cp in.las folder");
  if (!build_lacks("GDAL")) work.succeed("spillway dem -q in.las --resolution 20 -o like.tif");
}

class UnusedOption : public ::testing::TestWithParam<Unused> {};

TEST_P(UnusedOption, IsRefusedWithoutOutput) {
  const Workspace work;
  make_inputs(work);
  const auto names = work.names();
  const Result result = work.run(std::string("spillway ") + GetParam().arguments);
  EXPECT_EQ(result.exit_code, 2) << result.err;
  EXPECT_EQ(result.out, "");
  EXPECT_THAT(result.err, AllOf(StartsWith("spillway: error: "), HasSubstr(GetParam().message)));
  EXPECT_EQ(result.err.find('\n'), result.err.size() - 1) << result.err;
  EXPECT_EQ(work.names(), names);
}

std::string name_of(const ::testing::TestParamInfo<Unused>& info) { return info.param.name; }

INSTANTIATE_TEST_SUITE_P(
    Triangulate, UnusedOption,
    ::testing::Values(
        Unused{"DuplicatesInSpace", "triangulate space.npy --dim 3 -o a.spm --heights first",
               "--heights has no effect with --dim 3"},
        Unused{"DuplicatesOfFlatPoints", "triangulate flat.txt -o a.spm --heights highest",
               "--heights has no effect on points without z"},
        Unused{"ThinningByHeightOfFlatPoints", "triangulate flat.txt -o a.spm --thin 1:lowest",
               "the points have no z to thin them by"},
        Unused{"Parts", "triangulate in.las -o a.spm --parts", "start it with mpirun"},
        Unused{"DiskOfNoSimulation", "triangulate in.las -o a.spm --simulate-disk 1G",
               "--simulate-disk has no effect without --simulate-cores"},
        Unused{"PointsOfNoSimulation", "triangulate in.las -o a.spm --simulate-points 1e9",
               "--simulate-points has no effect without --simulate-cores"},
        Unused{"LevelsWithoutCopc", "triangulate in.las -o a.spm --resolution 1",
               "in.las is not a COPC file"}),
    name_of);

INSTANTIATE_TEST_SUITE_P(
    Dem, UnusedOption,
    ::testing::Values(
        Unused{"DuplicatesOfAMesh", "dem tin.ply -o a.tif --resolution 5 --heights highest",
               "--heights has no effect on tin.ply, which is a mesh: leave it out"},
        Unused{"DivisionOfAMesh",
               "dem tin.spm -o a.tif --resolution 5 --tile-points 9 --leaf-points 9 --division "
               "cycling "
               "--children 3 --kernel cgal",
               "--leaf-points, --tile-points, --division, --children and --kernel have no effect "
               "on tin.spm, "
               "which is a mesh: leave them out"},
        Unused{"FiltersOfAMesh",
               "dem tin.ply -o a.tif --resolution 5 --keep-withheld --every 2 --keep-class 2 "
               "--drop-class 3 --returns last --thin 3",
               "--keep-withheld, --every, --keep-class, --drop-class, --returns and --thin have no "
               "effect on tin.ply"},
        Unused{"ForceCrsOfAMesh", "dem tin.ply -o a.tif --resolution 5 --force-crs",
               "--force-crs has no effect on tin.ply"},
        Unused{"MeshFormatOfSeveral", "dem in.las in.las -o a.tif --resolution 5 --mesh-format ply",
               "--mesh-format has no effect on several inputs"},
        Unused{"MeshFormatOfAFolder", "dem folder -o a.tif --resolution 5 --mesh-format ply",
               "--mesh-format has no effect on several inputs"},
        Unused{"TwoFormats",
               "dem in.las -o a.tif --resolution 5 --mesh-format ply --input-format las",
               "--mesh-format has no effect with --input-format"},
        Unused{"Azimuth", "dem in.las -o a.tif --resolution 5 --azimuth 9",
               "--azimuth has no effect without hillshade among the products"},
        Unused{"Altitude",
               "dem tin.ply -o a.tif --resolution 5 --product height,slope --altitude 9",
               "--altitude has no effect without hillshade"},
        Unused{"MaxEdgeOfDensity",
               "dem in.las -o a.tif --resolution 5 --product density --max-edge 9",
               "--max-edge has no effect on density"},
        Unused{"DuplicatesOfDensity",
               "dem in.las -o a.tif --resolution 5 --product density --heights mean",
               "--heights has no effect on density"},
        Unused{"GridWithLike", "dem in.las -o a.tif --like like.tif --resolution 3 --align",
               "--resolution and --align have no effect with --like"}),
    name_of);

INSTANTIATE_TEST_SUITE_P(
    Contour, UnusedOption,
    ::testing::Values(
        Unused{"BaseWithLevels", "contour in.las -o a.gpkg --levels 380 --base 0",
               "--base has no effect with --levels"},
        Unused{"IntervalWithLevels", "contour in.las -o a.gpkg --levels 380 --interval 5",
               "--interval has no effect with --levels"},
        Unused{"OptionsOfLinesWithBands",
               "contour in.las -o a.gpkg --interval 5 --bands --index 5 --min-length 3",
               "--index and --min-length have no effect with --bands"},
        Unused{"IndexWithLevels", "contour in.las -o a.gpkg --levels 380 --index 5",
               "--index has no effect with --levels"},
        Unused{"DimensionThereIsNot", "contour tin.ply -o a.gpkg --levels 380 --dim 3",
               "contour has no option --dim"},
        Unused{"PointOptionsOfAMesh",
               "contour tin.spm -o a.gpkg --levels 380 --heights lowest --force-crs "
               "--bounds 0,0,1,1 --resolution 3",
               "--force-crs, --bounds, --resolution and --heights have no effect on tin.spm"}),
    name_of);

INSTANTIATE_TEST_SUITE_P(
    Render, UnusedOption,
    ::testing::Values(
        Unused{"DimensionOfAMesh", "render tin.spm -o a.png --dim 2",
               "--dim has no effect on tin.spm, which is a mesh"},
        Unused{"DuplicatesOfAMesh", "render tin.ply -o a.png --heights lowest",
               "--heights has no effect on tin.ply"},
        Unused{"DuplicatesInSpace", "render space.npy --dim 3 -o a.png --heights lowest",
               "--heights has no effect with --dim 3"},
        Unused{"FiltersOfAMesh", "render space.vtu -o a.png --every 3 --bounds 0,0,1,1",
               "--every and --bounds have no effect on space.vtu"},
        Unused{"WireframeOfASlice", "render space.npy --dim 3 -o a.png --slice z=0.5 --wireframe",
               "a wireframe is of the hull and of terrains"},
        Unused{"ExaggerationInSpace", "render space.npy --dim 3 -o a.png --exaggerate 2",
               "heights are exaggerated of terrains"},
        Unused{"ZoomToAHull", "render space.npy --dim 3 -o a.png --zoom 0,0,1,1",
               "a zoom is of terrains and slices"},
        Unused{"ShadowsInSpace", "render space.npy --dim 3 -o a.png --shadows",
               "light and shadows are chosen of terrains"},
        Unused{"SliceOfATerrain", "render in.las -o a.png --slice z=380",
               "a slice is of tetrahedra"}),
    name_of);

INSTANTIATE_TEST_SUITE_P(
    Info, UnusedOption,
    ::testing::Values(
        Unused{"FilterOfAMesh", "info tin.ply --keep-class 2",
               "--keep-class has no effect on tin.ply, which is a mesh"},
        Unused{"FilterOfMeshes", "info tin.ply tin.spm --every 2",
               "--every has no effect on these files, which are meshes"},
        Unused{"FormatOfAMesh", "info tin.ply --input-format las",
               "--input-format has no effect on tin.ply"},
        Unused{"FilterOfAPipe", "info - --returns last < tin.spm", "--returns has no effect on -"},
        Unused{"ForceCrs", "info in.las --force-crs", "info has no option --force-crs"}),
    name_of);

INSTANTIATE_TEST_SUITE_P(
    Check, UnusedOption,
    ::testing::Values(
        Unused{"FilterWithoutPoints", "check tin.ply --keep-class 2",
               "--keep-class has no effect without --points"},
        Unused{"InputOptionsWithoutPoints",
               "check tin.spm --input-format las --force-crs --bounds 0,0,1,1 --thin 3",
               "--input-format, --force-crs, --bounds and --thin have no effect without --points"}),
    name_of);

INSTANTIATE_TEST_SUITE_P(
    Convert, UnusedOption,
    ::testing::Values(
        Unused{
            "PointOptionsOfAMesh",
            "convert tin.ply -o a.obj --force-crs --keep-withheld --every 2 --scale 1 --offset 0 "
            "--las-version 1.2",
            "--force-crs, --keep-withheld, --every, --scale, --offset and --las-version have no "
            "effect on tin.ply, which is a mesh"},
        Unused{"TwoFormats", "convert tin.ply -o a.obj --mesh-format ply --input-format las",
               "--input-format has no effect on tin.ply"},
        Unused{"LasVersionOfText", "convert in.las -o a.txt --las-version 1.4",
               "--las-version is for LAS"},
        Unused{"ThinningByHeightOfFlatPoints", "convert flat.txt -o a.npy --thin 1:highest",
               "the points have no z to thin them by"}),
    name_of);

INSTANTIATE_TEST_SUITE_P(
    Generate, UnusedOption,
    ::testing::Values(Unused{"DimensionOfTerrain", "generate terrain -n 9 --dim 3 -o a.las",
                             "--dim has no effect on terrain"},
                      Unused{"SeedOfALattice", "generate lattice -n 9 --seed 2 -o a.las",
                             "--seed has no effect on lattice"},
                      Unused{"OverlapWithoutGrid", "generate terrain -n 9 --overlap 0.1 -o a.las",
                             "--overlap has no effect without --grid"},
                      Unused{"LasVersionOfATextGrid",
                             "generate terrain -n 9 --grid 2x2 -o a#.txt --las-version 1.2",
                             "--las-version is for LAS"},
                      Unused{"LasVersionOfText", "generate terrain -n 9 -o a.txt --las-version 1.2",
                             "--las-version is for LAS"}),
    name_of);

INSTANTIATE_TEST_SUITE_P(
    Batch, UnusedOption,
    ::testing::Values(
        Unused{"AzimuthWithoutHillshade",
               "batch in.las --output-dir out --to dem.tif,slope.tif --resolution 9 --azimuth 9",
               "none of its outputs uses the option --azimuth"},
        Unused{"OfABatchWithoutShades",
               "batch in.las --output-dir out --to dem.tif,tpi.tif --resolution 9 --type byte",
               "none of its outputs uses the option --type"},
        Unused{"ProductOfANamedProduct",
               "batch in.las --output-dir out --to slope.tif --resolution 9 --product height",
               "none of its outputs uses the option --product"},
        Unused{"DuplicatesOfDensity",
               "batch in.las --output-dir out --to density.tif --resolution 9 --heights mean",
               "none of its outputs uses the option --heights"}),
    name_of);

INSTANTIATE_TEST_SUITE_P(
    NoOption, UnusedOption,
    ::testing::Values(Unused{"BeforeTheInput", "triangulate --bogus in.las",
                             "triangulate has no option --bogus"},
                      Unused{"WithASuggestion", "triangulate in.las --height first",
                             "triangulate has no option --height (did you mean --heights?)"},
                      Unused{"WithAValue", "dem in.las --product=slope --resolutoin=5",
                             "dem has no option --resolutoin (did you mean --resolution?)"},
                      Unused{"Short", "triangulate in.las -x", "triangulate has no option -x (see"},
                      Unused{"BeforeTheSubcommand", "--threads 2 triangulate in.las -o a.spm",
                             "--threads is an option of triangulate: give it after that word"}),
    name_of);

TEST(UnusedOptions, OfABatchFailTheirJobOnly) {
  if (build_lacks("GDAL")) GTEST_SKIP() << kNoGdal;
  const Workspace work;
  make_inputs(work);
  work.write("jobs.json",
             R"({"to": "dem.tif", "options": {"resolution": 20},
                 "jobs": [{"in": "tin.ply", "options": {"kernel": "cgal"}}, {"in": "in.las"}]})");
  const Result result = work.run("spillway batch jobs.json --output-dir out");
  EXPECT_EQ(result.exit_code, 1) << result.err;
  EXPECT_THAT(work.read("out/tin.log"), HasSubstr("--kernel has no effect on tin.ply"));
  EXPECT_TRUE(work.has("out/in.dem.tif"));
  EXPECT_FALSE(work.has("out/tin.dem.tif"));
}

TEST(UnusedOptions, OfABatchGoToTheStepsThatUseThem) {
  if (build_lacks("GDAL")) GTEST_SKIP() << kNoGdal;
  const Workspace work;
  make_inputs(work);
  work.succeed(
      "spillway batch in.las --output-dir out --to dem.tif,hillshade.tif,density.tif --resolution "
      "9 "
      "--azimuth 90 --max-edge 99 --heights lowest\n"
      "spillway dem -q in.las --resolution 9 --product hillshade --azimuth 90 --max-edge 99 "
      "--heights lowest -o light.tif\n"
      "cmp light.tif out/in.hillshade.tif\n"
      "spillway batch in.las --output-dir bytes --to dem.tif,tri.tif,multi-hillshade.tif "
      "--resolution 9 --type byte --nodata 7 --compute-edges --gradient horn --altitude 30\n"
      "spillway dem -q in.las -o four.tif --resolution 9 --product multi-hillshade --type byte "
      "--compute-edges --gradient horn --altitude 30\n"
      "cmp four.tif bytes/in.multi-hillshade.tif\n"
      "spillway batch in.las --output-dir like --to spm,dem.tif --like like.tif --force-crs");
}

TEST(UnusedOptions, ThatHaveAnEffectOnSomeInputAreTaken) {
  if (build_lacks("GDAL")) GTEST_SKIP() << kNoGdal;
  const Workspace work;
  make_inputs(work);
  EXPECT_THAT(work.succeed("spillway info tin.ply in.las --every 5"),
              HasSubstr("filters every    400"));
  EXPECT_THAT(work.succeed("cat in.las | spillway info tin.ply - --every 5"),
              HasSubstr("filters every    400"));
  work.succeed(
      "spillway dem -q tin.ply -o a.tif --like like.tif --force-crs\n"
      "spillway dem -q tin.ply -o b.tif --resolution 9 --bounds 500000,4100000,500100,4100100\n"
      "spillway dem -q tin.ply -o c.tif --resolution 9 --product density,slope --max-edge 9\n"
      "spillway check -q tin.ply --memory 64M --scratch-folder . --max-tmp 1G > report\n"
      "spillway render -q tin.ply -o a.png --max-edge 99 --threads 1\n"
      "spillway triangulate -q in.las flat.txt -o a.spm --heights highest");
}

}  // namespace
}  // namespace spillway::test
