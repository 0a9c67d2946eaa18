#include <map>

#include "tests/formats/shared_data.h"

namespace spillway::test {
namespace {

using ::testing::ElementsAre;
using ::testing::Pair;

class SharedLaz : public ::testing::TestWithParam<Sample> {
 protected:
  void SetUp() override {
    if (!std::filesystem::exists(path_)) GTEST_SKIP() << path_ << " is not there";
  }

  const std::filesystem::path path_ = shared_file(GetParam().file);
};

TEST_P(SharedLaz, HasTheDocumentedPoints) {
  const AllPoints all = read_all_points(disk(), path_, {"", true});
  EXPECT_EQ(all.header.count, GetParam().points);
  EXPECT_EQ(all.points.size(), GetParam().points);
  EXPECT_EQ(all.index.back(), GetParam().points - 1);
  EXPECT_EQ(sha256_of_points(all.points), GetParam().sha256);
}

TEST_P(SharedLaz, HasThemOnAPipeToo) {
  FaultyFileSystem files;
  files.seekable = false;
  files.files["-"] = content_of(path_);
  const AllPoints all = read_all_points(files, "-", {"", true});
  EXPECT_EQ(all.points.size(), GetParam().points);
  EXPECT_EQ(sha256_of_points(all.points), GetParam().sha256);
}

/// The sample of item versions 1 in one chunk has no documented digest, but it is another file's
/// points in another order of bytes.
INSTANTIATE_TEST_SUITE_P(
    Files, SharedLaz,
    ::testing::Values(Sample{"autzen_trim.laz", 110000, kAutzenPoints},
                      Sample{"lone-star.laz", 518862,
                             "ad3e02f7f632e72963ed895d7077559c4c33614e2154e87a61f58c87fb59d24b"},
                      Sample{"crop_1.laz", 98940,
                             "b3974a49e3358e8eb07a41bad943bfe8f2b79ac872ddc4f670b89a61697c9642"},
                      Sample{"las_with_several_extra_byte_bloc.laz", 697721,
                             "22640cb1964c9d28de509ff5f9dcc15e0a51da5c35ded805152f2531a916d200"},
                      Sample{"1.2-with-color.copc.laz", 1065,
                             "70f48a990e075a441f0d0ea78e84e333da948915ae6a344561abd58f7454e125"},
                      Sample{"simple-laszip-compressor-version-1.2r0.laz", 1065,
                             "2c4ac1f33f3b3bc74cc6345387e596fccd5e5dfee8c0af96c1c48be76cd560f4"}),
    name_of_sample);

using Classes = std::map<int, std::uint64_t>;

Classes classes_of(const AllPoints& all) {
  Classes classes;
  for (const LasFlags& attributes : all.attributes) ++classes[attributes.classification];
  return classes;
}

AllPoints with_attributes(const char* name) {
  return read_all_points(disk(), shared_file(name), {"", true}, true);
}

TEST(SharedLazAttributes, ClassesOfPointwiseChunks) {
  const char* const name = "crop_1.laz";
  if (!std::filesystem::exists(shared_file(name))) GTEST_SKIP() << name << " is not there";
  EXPECT_THAT(classes_of(with_attributes(name)), ElementsAre(Pair(2, 34122U), Pair(6, 64818U)));
}

TEST(SharedLazAttributes, ClassesOfLayeredChunks) {
  const char* const name = "las_with_several_extra_byte_bloc.laz";
  if (!std::filesystem::exists(shared_file(name))) GTEST_SKIP() << name << " is not there";
  EXPECT_THAT(classes_of(with_attributes(name)),
              ElementsAre(Pair(1, 3262U), Pair(2, 683023U), Pair(3, 960U), Pair(4, 873U),
                          Pair(5, 9003U), Pair(6, 590U), Pair(65, 10U)));
}

TEST(SharedLazAttributes, AreThoseOfTheUncompressedFile) {
  if (!std::filesystem::exists(shared_file("autzen_trim.laz"))) {
    GTEST_SKIP() << "autzen_trim.laz is not there";
  }
  const AllPoints plain = with_attributes("autzen_trim.las");
  const AllPoints compressed = with_attributes("autzen_trim.laz");
  EXPECT_EQ(compressed.points, plain.points);
  EXPECT_EQ(compressed.index, plain.index);
  ASSERT_EQ(plain.attributes.size(), 110000U);
  EXPECT_TRUE(compressed.attributes == plain.attributes);
  EXPECT_EQ(compressed.header.crs, plain.header.crs);
  EXPECT_THAT(classes_of(compressed), ElementsAre(Pair(1, 83893U), Pair(2, 26107U)));
}

}  // namespace
}  // namespace spillway::test
