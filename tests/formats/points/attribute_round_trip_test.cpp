// What LAS says of points comes back from other formats as it was.

#include <fmt/format.h>

#include <string>

#include "formats/points/create_points.h"
#include "tests/formats/points/all_attributes.h"
#include "tests/formats/points/laz/laz_encoder/laz_file.h"
#include "tests/formats/points/laz/laz_encoder/random_records.h"

namespace spillway::detail::testing {
namespace {

constexpr std::size_t kPoints = 2000;

LazFormat format_of(int point_format) {
  LazFormat format;
  format.point_format = point_format;
  format.extra_bytes = 5;
  if (point_format >= 6) {
    format.compressor = 3;
    format.version = 3;
  }
  return format;
}

/// Points of a LAZ file with that point format, its attributes included.
Carried random_points(int point_format) {
  FaultyFileSystem files;
  files.files["a.laz"] =
      make_laz_file(format_of(point_format), RandomRecords{point_format, 5, kPoints, 11}.make())
          .bytes();
  return read_carried(files, "a.laz", {.keep_withheld = true});
}

class LasAttributes : public ::testing::TestWithParam<int> {};

TEST_P(LasAttributes, ComeBackFromNpy) {
  const Carried las = random_points(GetParam());
  ASSERT_EQ(las.points.size(), kPoints);
  ASSERT_FALSE(las.layout.empty());
  FaultyFileSystem files;
  const auto writer =
      open_point_writer(files, "a.npy", {.lattice = las.header.lattice, .attributes = las.layout});
  writer->write(las.points, las.records);
  writer->finish();
  const Carried back = read_carried(files, "a.npy", {}, las.layout);
  EXPECT_EQ(back.records, las.records);
  ASSERT_EQ(back.points.size(), kPoints);
  for (std::size_t i = 0; i < kPoints; ++i) {
    EXPECT_EQ(back.points[i], LatticePoint(in_world(las.header.lattice, las.points[i]).numbers()));
  }
}

INSTANTIATE_TEST_SUITE_P(EveryPointFormat, LasAttributes, ::testing::Range(0, 11));

}  // namespace
}  // namespace spillway::detail::testing
