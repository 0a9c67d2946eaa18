// Compressed surveys, whose headers and octrees tell where points lie, are triangulated while they
// are read, and as if all were read first.

#include <gtest/gtest.h>

#include <string>

#include "tests/formats/points/copc/encoded_files.h"
#include "tests/tools/command_runner.h"

namespace spillway::test {
namespace {

class Encoded : public ::testing::Test {
 protected:
  void generate(const std::string& options) const {
    work_.succeed("spillway generate -q terrain " + options);
  }

  [[nodiscard]] EncodedPoints points_of(const std::string& name) const {
    return read_points_to_encode(work_.folder() / name);
  }

  [[nodiscard]] nlohmann::json triangulate(const std::string& arguments) const {
    work_.succeed("spillway triangulate -q --tile-points 2000 -o mesh.spm --stats stats.json " +
                  arguments);
    return nlohmann::json::parse(work_.read("stats.json"));
  }

  /// These files are triangulated early; the mesh is that of all their points read first.
  void expect_early(const std::string& files, int points) const {
    const nlohmann::json early = triangulate(files);
    const nlohmann::json late = triangulate(files + " --no-trust-headers");
    EXPECT_EQ(early["points"], points);
    EXPECT_LT(early["first_block_read_points"], points * 9 / 10);
    EXPECT_EQ(late["first_block_read_points"], points);
    EXPECT_EQ(early["canonical_hash"], late["canonical_hash"]);
    EXPECT_EQ(early["canonical_hash"], triangulate("all.las")["canonical_hash"]);
  }

  Workspace work_;
};

TEST_F(Encoded, OneCopcFileIsTriangulatedEarlyNodeByNode) {
  generate("-n 60000 -o all.las");
  work_.write("all.copc.laz", copc_bytes(points_of("all.las")));
  EXPECT_EQ(work_.info("all.copc.laz")["points"], 60'000);
  expect_early("all.copc.laz", 60'000);
}

TEST_F(Encoded, CopcFilesOfASurveyAreTriangulatedEarly) {
  generate("-n 60000 -o all.las");
  generate("-n 60000 --grid 2x1 -o 't_#.las'");
  for (const std::string tile : {"t_00_00", "t_01_00"}) {
    work_.write(tile + ".copc.laz", copc_bytes(points_of(tile + ".las")));
  }
  expect_early("t_*.copc.laz", 60'000);
}

TEST_F(Encoded, LazFilesOfASurveyAreTriangulatedEarly) {
  generate("-n 30000 -o all.las");
  generate("-n 30000 --grid 4x4 -o 't_#.las'");
  for (const std::string& las : work_.names()) {
    if (!las.starts_with("t_")) continue;
    work_.write(las.substr(0, las.find('.')) + ".laz", laz_bytes(points_of(las)));
  }
  expect_early("t_*.laz", 30'000);
}

}  // namespace
}  // namespace spillway::test
