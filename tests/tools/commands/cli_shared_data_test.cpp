// Real LiDAR: the statistics of the sample files' README.

#include <gtest/gtest.h>

#include <string>

#include "tests/test_paths.h"
#include "tests/tools/command_runner.h"

namespace spillway::test {
namespace {

struct Sample {
  std::string name;
  int points;
  int distinct;
  int triangles;
  int hull;
  int tetrahedra;  // 0: the z scale is another, so the figure, of the integers, does not apply
};

std::ostream& operator<<(std::ostream& out, const Sample& sample) { return out << sample.name; }

class EverySample : public ::testing::TestWithParam<Sample> {
 protected:
  void SetUp() override {
    path_ = shared_file(GetParam().name).string();
    if (path_.empty()) GTEST_SKIP() << "no " << GetParam().name << " in " << shared_data_folder();
  }

  std::string path_;
};

TEST_P(EverySample, GivesTheTrianglesOfItsReadmeAndIsProved) {
  const Workspace work;
  const Sample& sample = GetParam();
  work.succeed("spillway triangulate -q --keep-withheld '" + path_ +
               "' -o tin.ply --stats stats.json");
  const auto stats = nlohmann::json::parse(work.read("stats.json"));
  EXPECT_EQ(stats["points"], sample.points);
  EXPECT_EQ(stats["vertices"], sample.distinct);
  EXPECT_EQ(stats["simplices"], sample.triangles);
  EXPECT_EQ(stats["hull_facets"], sample.hull);
  EXPECT_EQ(stats["canonical_hash"], work.info("tin.ply")["canonical_hash"]);
  work.succeed("spillway check -q tin.ply --keep-withheld --points '" + path_ + "'");
}

TEST_P(EverySample, GivesTheTetrahedraOfItsReadme) {
  const Sample& sample = GetParam();
  if (sample.tetrahedra == 0) GTEST_SKIP() << "the axes of " << sample.name << " differ in scale";
  const Workspace work;
  work.succeed("spillway triangulate -q --keep-withheld --dim 3 '" + path_ +
               "' -o tetrahedra.ply --stats stats.json");
  EXPECT_EQ(nlohmann::json::parse(work.read("stats.json"))["simplices"], sample.tetrahedra);
}

INSTANTIATE_TEST_SUITE_P(
    Cli, EverySample,
    ::testing::Values(Sample{"autzen_trim.las", 110000, 109993, 219955, 29, 674698},
                      Sample{"autzen_trim_7.las", 110000, 109993, 219955, 29, 674698},
                      Sample{"1.2-with-color.las", 1065, 1065, 2114, 14, 6246},
                      Sample{"hexbin-crop.las", 38367, 38367, 76697, 35, 0},
                      Sample{"4_6_crop.las", 23875, 23875, 47722, 26, 156598},
                      Sample{"mvk-thin.las", 6280, 6280, 12532, 26, 38532},
                      Sample{"rand1_6.las", 50000, 50000, 99965, 33, 335152},
                      Sample{"sample_nc.las", 14408, 14373, 28724, 20, 87183},
                      Sample{"autzen_trim.laz", 110000, 109993, 219955, 29, 674698},
                      Sample{"lone-star.laz", 518862, 518182, 1036333, 29, 3319078},
                      Sample{"crop_1.laz", 98940, 98940, 197844, 34, 622736},
                      Sample{"las_with_several_extra_byte_bloc.laz", 697721, 697712, 1395201, 221,
                             4178751},
                      Sample{"1.2-with-color.copc.laz", 1065, 1065, 2114, 14, 6246}));

}  // namespace
}  // namespace spillway::test
