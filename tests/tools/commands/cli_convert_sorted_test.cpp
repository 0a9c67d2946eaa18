// `convert --sorted`: points cell by cell, from any input, for files and pipes.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "tests/tools/command_runner.h"

namespace spillway::test {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

TEST(ConvertSorted, TheMeshIsThatOfTheInput) {
  const Workspace work;
  for (const std::string points :
       {"terrain -n 300000", "uniform -n 100000", "lattice -n 40000", "uniform -n 10"}) {
    work.succeed(
        "spillway generate -q " + points +
        " -o in.spp\n"
        "spillway convert -q in.spp --sorted --cell-points 5000 --memory 32M -o sorted.spp\n"
        "spillway triangulate -q in.spp -o a.spm\n"
        "spillway triangulate -q sorted.spp -o b.spm --memory 32M");
    EXPECT_EQ(work.info("a.spm")["canonical_hash"], work.info("b.spm")["canonical_hash"]);
    EXPECT_EQ(work.info("in.spp")["points"], work.info("sorted.spp")["points"]);
    EXPECT_EQ(work.info("in.spp")["extent"], work.info("sorted.spp")["extent"]);
  }
}

TEST(ConvertSorted, Tetrahedra) {
  const Workspace work;
  work.succeed(
      "spillway generate -q uniform --dim 3 -n 30000 -o in.npy\n"
      "spillway convert -q in.npy --sorted --dim 3 --cell-points 2000 -o sorted.spp\n"
      "spillway triangulate -q --dim 3 in.npy -o a.spm\n"
      "spillway triangulate -q --dim 3 sorted.spp -o b.spm");
  EXPECT_EQ(work.info("a.spm")["canonical_hash"], work.info("b.spm")["canonical_hash"]);
}

TEST(ConvertSorted, FromPipesToPipes) {
  const Workspace work;
  work.succeed(
      "spillway generate -q terrain -n 200000 | spillway convert - --sorted -q -o - --cell-points "
      "9000 | spillway triangulate -q - -o a.spm\n"
      "spillway generate -q terrain -n 200000 | spillway triangulate -q - -o b.spm");
  EXPECT_EQ(work.info("a.spm")["canonical_hash"], work.info("b.spm")["canonical_hash"]);
}

TEST(ConvertSorted, SeveralFilesWithFilters) {
  const Workspace work;
  work.succeed(
      "spillway generate -q terrain -n 50000 -o a.las\n"
      "spillway generate -q terrain -n 30000 --seed 2 -o b.las\n"
      "spillway convert -q a.las b.las --every 2 --thin 2:lowest -o plain.spp\n"
      "spillway convert -q a.las b.las --every 2 --thin 2:lowest --sorted --cell-points 1000 -o "
      "sorted.spp\n"
      "for f in plain sorted; do spillway convert -q $f.spp -o - --output-format text | sort > "
      "$f.txt; done\n"
      "cmp plain.txt sorted.txt");
}

TEST(ConvertSorted, TellsWhatItDid) {
  const Workspace work;
  work.succeed("spillway generate -q uniform -n 1000 -o in.spp");
  EXPECT_THAT(work.run("spillway convert in.spp --sorted -o out.spp").err,
              HasSubstr("1000 points in out.spp, sorted in 1 cell\n"));
  EXPECT_EQ(work.info("out.spp")["version"], "2");
  EXPECT_EQ(work.info("out.spp")["cells"], 1);
  EXPECT_FALSE(work.info("in.spp").contains("cells"));
  work.write("none.txt", "# nothing\n");
  work.succeed("spillway convert none.txt --sorted -q -o none.spp");
  EXPECT_EQ(work.info("none.spp")["points"], 0);
}

TEST(ConvertSorted, RefusesWhatHasNoEffect) {
  const Workspace work;
  work.succeed(
      "spillway generate -q uniform -n 100 -o in.spp\n"
      "spillway triangulate -q in.spp -o in.spm");
  const auto refused = [&](const std::string& options, const std::string& words) {
    const Result result = work.run("spillway convert " + options);
    EXPECT_EQ(result.exit_code, 2) << options;
    EXPECT_THAT(result.err, HasSubstr(words));
  };
  refused("in.spp --sorted -o out.las", "--sorted is for spp, and out.las is LAS");
  refused("in.spp --sorted -o - --output-format text", "--sorted is for spp");
  refused("in.spp --cell-points 5 -o out.spp", "--cell-points has no effect without --sorted");
  refused("in.spp --dim 3 -o out.spp", "--dim has no effect without --sorted");
  refused("in.spp --sorted --cell-points 0 -o out.spp", "--cell-points");
  refused("in.spm --sorted -o out.ply", "--sorted has no effect on in.spm");
  refused("in.spm --sorted --dim 3 -o out.ply", "have no effect on in.spm");
}

TEST(ConvertSorted, ACopyCutShortIsAnError) {
  const Workspace work;
  work.succeed(
      "spillway generate -q uniform -n 20000 -o in.spp\n"
      "spillway convert -q in.spp --sorted --cell-points 1000 -o out.spp\n"
      "head -c 100000 out.spp > cut.spp");
  const Result result = work.run("spillway triangulate cut.spp -o out.spm");
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_THAT(result.err, AllOf(HasSubstr("cut.spp: the stream is cut short at byte 100000")));
}

}  // namespace
}  // namespace spillway::test
