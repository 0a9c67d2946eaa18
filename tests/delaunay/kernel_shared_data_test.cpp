// The own kernels and CGAL on sample files outside of the repository: equal triangulations, in the
// plane and in space, duplicates included.

#include <array>
#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "tests/delaunay/kernel_sets.h"
#include "tests/formats/shared_data.h"

namespace spillway::test {
namespace {

/// Of larger files as many are taken.
constexpr std::size_t kMostPoints = 300'000;

/// A seed for which points are given in the order of the curve, as the kernels like it.
constexpr std::uint64_t kCurveOrder = 0;

class KernelsOfSharedFile : public ::testing::TestWithParam<const char*> {};

TEST_P(KernelsOfSharedFile, EqualCgal) {
  const std::filesystem::path path = shared_file(GetParam());
  if (!std::filesystem::exists(path)) GTEST_SKIP() << path << " is not there";
  const std::vector<LatticePoint> read = read_all_points(disk(), path, {"", true}).points;
  std::vector<Point<3>> points(read.begin(), read.end());
  if (points.size() > kMostPoints) points.resize(kMostPoints);
  std::vector<Point<2>> flat;
  for (const Point<3>& p : points) flat.push_back({p[0], p[1]});
  EXPECT_EQ(compare_kernel_with_cgal<2>(flat, kCurveOrder), "");
  EXPECT_EQ(compare_kernel_with_cgal<3>(points, kCurveOrder), "");
}

INSTANTIATE_TEST_SUITE_P(Files, KernelsOfSharedFile,
                         ::testing::Values("1.2-with-color.las", "1.2-with-color.copc.laz",
                                           "4_6_crop.las", "autzen_trim.las", "autzen_trim.laz",
                                           "autzen_trim_7.las", "crop_1.laz", "hexbin-crop.las",
                                           "las_with_several_extra_byte_bloc.laz", "lone-star.laz",
                                           "mvk-thin.las", "rand1_6.las", "sample_nc.las",
                                           "simple-laszip-compressor-version-1.2r0.laz"),
                         [](const ::testing::TestParamInfo<const char*>& tested) {
                           return name_of_sample({Sample{tested.param, 0, ""}, tested.index});
                         });

}  // namespace
}  // namespace spillway::test
