#include <sys/resource.h>

#include "tests/formats/shared_data.h"

namespace spillway::test {
namespace {

using ::testing::HasSubstr;

class SharedLas : public ::testing::TestWithParam<Sample> {};

TEST_P(SharedLas, HasTheDocumentedPoints) {
  const std::filesystem::path path = shared_file(GetParam().file);
  if (!std::filesystem::exists(path)) GTEST_SKIP() << path << " is not there";
  const AllPoints all = read_all_points(disk(), path, {"", true});
  EXPECT_EQ(all.points.size(), GetParam().points);
  EXPECT_EQ(all.header.count, GetParam().points);
  EXPECT_EQ(sha256_of_points(all.points), GetParam().sha256);
}

INSTANTIATE_TEST_SUITE_P(
    Files, SharedLas,
    ::testing::Values(Sample{"autzen_trim.las", 110000, kAutzenPoints},
                      Sample{"autzen_trim_7.las", 110000, kAutzenPoints},
                      Sample{"1.2-with-color.las", 1065,
                             "2c4ac1f33f3b3bc74cc6345387e596fccd5e5dfee8c0af96c1c48be76cd560f4"},
                      Sample{"hexbin-crop.las", 38367,
                             "6da52311a7b680d60185a2f5b094c7d572b34b01412a06e9c409b938c2d03b1f"},
                      Sample{"4_6_crop.las", 23875,
                             "1b0f7dc6ac45feffd9448e536799d379acacb4fd2ebb9cacf0f85377e90e5f86"},
                      Sample{"mvk-thin.las", 6280,
                             "1680a59cb873bb6dd01edf82e45f2945545c27a75d96ad08cfe5615e3f246a47"},
                      Sample{"rand1_6.las", 50000,
                             "bd883e63f84d4da7672995f7243026e5b8dfaf3e022cdd1b93f9c430933d9639"},
                      Sample{"sample_nc.las", 14408,
                             "67029f299a16900b372e5f60b783619a1d7568e3f2f5f20d9f2227f2681b9232"}),
    name_of_sample);

TEST(SharedLasRefused, Truncated) {
  const std::filesystem::path path = shared_file("1.2-with-color-clipped.las");
  if (!std::filesystem::exists(path)) GTEST_SKIP() << path << " is not there";
  EXPECT_THAT(error_of([&] { read_all_points(disk(), path); }),
              HasSubstr("1065 points of 34 bytes, but the file ends at byte 36405, after 1064"));
}

TEST(SharedLasRefused, CorruptVlrCount) {
  const std::filesystem::path path = shared_file("garbage_nVariableLength.las");
  if (!std::filesystem::exists(path)) GTEST_SKIP() << path << " is not there";
  rusage before{};
  ::getrusage(RUSAGE_SELF, &before);
  EXPECT_THAT(error_of([&] { read_all_points(disk(), path); }),
              HasSubstr("variable length records"));
  rusage after{};
  ::getrusage(RUSAGE_SELF, &after);
  EXPECT_LT(after.ru_maxrss - before.ru_maxrss, 4096) << "KiB";
}

}  // namespace
}  // namespace spillway::test
