// A product that one file and one line add: from points and meshes, by threads and over ranks.

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>

#include "tests/test_paths.h"
#include "tests/tools/command_runner.h"

namespace spillway::test {
namespace {

class AddedProduct : public ::testing::Test {
 protected:
  AddedProduct() { work_.succeed("spillway generate -q terrain -n 100000 --seed 5 -o in.las"); }

  [[nodiscard]] std::string mean_slope(const std::string& arguments) const {
    return work_.succeed(mean_slope_command_path() + " mean-slope -q " + arguments);
  }

  Workspace work_;
};

/// The mean of the slopes of the triangles of a plain and of one ramp.
TEST_F(AddedProduct, IsRightWhereItIsKnown) {
  work_.write("roof.txt", "0 0 0\n4 0 0\n0 4 0\n4 4 0\n8 0 4\n8 4 4\n");
  EXPECT_EQ(mean_slope("roof.txt"), "4 triangles, 6 vertices, mean slope 0.500000000\n");
}

TEST_F(AddedProduct, IsTheSameFromPointsAndMeshesByThreadsAndTiles) {
  const std::string expected = mean_slope("in.las --threads 1");
  work_.succeed("spillway triangulate -q in.las -o mesh.spm");
  EXPECT_THAT(expected, ::testing::StartsWith(fmt::format(
                            "{} triangles, {} vertices,",
                            work_.info("mesh.spm").at("simplices").get<std::uint64_t>(),
                            work_.info("mesh.spm").at("vertices").get<std::uint64_t>())));
  EXPECT_EQ(mean_slope("in.las --threads 2"), expected);
  EXPECT_EQ(mean_slope("in.las --tile-points 2000 --memory 32M --threads 2"), expected);
  EXPECT_EQ(mean_slope("mesh.spm"), expected);
  EXPECT_EQ(work_.succeed("cat in.las | " + mean_slope_command_path() + " mean-slope -q -"),
            expected);
}

TEST_F(AddedProduct, IsTheSameOverRanks) {
  if (build_lacks("MPI")) GTEST_SKIP() << "ranks take MPI";
  const std::string expected = mean_slope("in.las");
  for (const int ranks : {2, 3}) {
    EXPECT_EQ(work_.succeed(fmt::format("{} -n {} {} mean-slope -q in.las", mpirun_command(), ranks,
                                        mean_slope_command_path())),
              expected)
        << ranks << " ranks";
  }
}

}  // namespace
}  // namespace spillway::test
