// What holds for every family of points.

#include <bit>
#include <cmath>
#include <map>
#include <set>

#include <gmock/gmock.h>

#include "src/error.h"
#include "src/generators/generators.h"

namespace spillway::test {
namespace {

using ::testing::HasSubstr;

std::vector<Point<3>> in_blocks_of(std::size_t size, const GeneratorOptions& options) {
  const auto generator = make_generator(options);
  std::vector<Point<3>> block(size);
  std::vector<Point<3>> all;
  while (const std::size_t n = generator->next(block)) {
    all.insert(all.end(), block.begin(), block.begin() + static_cast<std::ptrdiff_t>(n));
    if (n < size) break;
  }
  EXPECT_EQ(generator->next(block), 0U) << "the stream goes on after its end";
  return all;
}

class EveryFamily : public ::testing::TestWithParam<std::string> {
 protected:
  static GeneratorOptions options(std::uint64_t count, int dimension, std::uint64_t seed = 1) {
    return {family_by_name(GetParam()), count, dimension, seed};
  }
};

TEST_P(EveryFamily, HasExactlyTheNumberOfPointsAskedFor) {
  for (const std::uint64_t count : {0, 1, 2, 3, 4, 7, 8, 9, 27, 28, 1000}) {
    EXPECT_EQ(generated_points<2>(options(count, 2)).size(), count);
    EXPECT_EQ(generated_points<3>(options(count, 3)).size(), count);
  }
}

TEST_P(EveryFamily, IsTheSameForEveryBlockSize) {
  for (const int dimension : {2, 3}) {
    const auto expected = in_blocks_of(5000, options(4001, dimension));
    EXPECT_EQ(expected.size(), 4001U);
    EXPECT_EQ(in_blocks_of(1, options(4001, dimension)), expected);
    EXPECT_EQ(in_blocks_of(7, options(4001, dimension)), expected);
    EXPECT_EQ(in_blocks_of(4001, options(4001, dimension)), expected);
  }
}

TEST_P(EveryFamily, DiffersFromSeedToSeedUnlessItIsTheGrid) {
  const bool same =
      generated_points<3>(options(100, 3, 1)) == generated_points<3>(options(100, 3, 2));
  EXPECT_EQ(same, GetParam() == "lattice");
}

TEST_P(EveryFamily, IsFiniteAndFlatInTwoDimensionsUnlessItAlwaysHasHeights) {
  for (const Point<3>& p : in_blocks_of(64, options(2000, 2))) {
    EXPECT_TRUE(std::isfinite(p[0]) && std::isfinite(p[1]) && std::isfinite(p[2]));
    EXPECT_TRUE(p[2] == 0 || always_has_heights(family_by_name(GetParam())));
  }
}

TEST_P(EveryFamily, WithALatticeConsistsOfIntegersThatFitLas) {
  for (const int dimension : {2, 3}) {
    const auto generator = make_generator(options(3000, dimension));
    if (generator->lattice() == nullptr) continue;
    std::vector<Point<3>> points(3000);
    ASSERT_EQ(generator->next(points), 3000U);
    for (const Point<3>& p : points) {
      for (const double x : p) {
        EXPECT_EQ(x, std::nearbyint(x));
        EXPECT_LT(std::abs(x), 0x1p31);
      }
    }
  }
}

TEST_P(EveryFamily, GivesItsPointsToCallersOfEitherDimension) {
  const auto stream = in_blocks_of(50, options(50, 3));
  const auto points = generated_points<3>(options(50, 2));  // the template decides
  EXPECT_EQ(points, stream);
}

/// A fingerprint of the points' bits, in order.
std::uint64_t fingerprint(const std::vector<Point<3>>& points) {
  std::uint64_t hash = 0;
  for (const Point<3>& p : points) {
    for (const double x : p) hash = hash * 0x9e3779b97f4a7c15ULL + std::bit_cast<std::uint64_t>(x);
  }
  return hash;
}

TEST_P(EveryFamily, IsTheSameOnEveryMachineAndInEveryVersion) {
  // Statistics measured on these points would no longer be comparable if they changed.
  const std::map<std::string, std::uint64_t> fingerprints = {
      {"uniform", 0xfa56f980c641dc72ULL},   {"normal", 0x366218110e045591ULL},
      {"bubbles", 0xfe8618b7aa74a4a1ULL},   {"ellipsoid", 0xb6cf6a25e1d760dfULL},
      {"lines", 0xbebe222f5357fa71ULL},     {"lattice", 0x057a000000000000ULL},
      {"circle", 0x45cb18f4f86f7e33ULL},    {"terrain", 0xdb49bc6000000000ULL},
      {"clusters", 0x9fe1114c6cb00ba1ULL},  {"duplicates", 0x432eac0a00000000ULL},
      {"collinear", 0xbf5c572f78400000ULL}, {"coplanar", 0xc9b80b67f8000000ULL},
      {"utm", 0x3089ad458dcf5fa3ULL},       {"packing", 0x132d0f9a523dfbe3ULL},
      {"scan", 0xc69ce40700000000ULL},      {"haloes", 0x649c96ef0c65d50eULL},
  };
  EXPECT_EQ(fingerprint(in_blocks_of(999, options(10000, 3, 5))), fingerprints.at(GetParam()));
}

INSTANTIATE_TEST_SUITE_P(Families, EveryFamily, ::testing::ValuesIn(family_names()),
                         [](const auto& family) { return family.param; });

TEST(FamilyNames, LeadBackToTheirFamilies) {
  const auto names = family_names();
  EXPECT_EQ(std::set(names.begin(), names.end()).size(), names.size());
  for (std::size_t i = 0; i < names.size(); ++i) {
    EXPECT_EQ(family_by_name(names[i]), static_cast<Family>(i));
  }
  EXPECT_EQ(family_by_name("terrain"), Family::kTerrain);
  EXPECT_EQ(family_by_name("haloes"), Family::kHaloes);
}

TEST(FamilyNames, UnknownIsAnInvalidArgumentThatListsThem) {
  try {
    family_by_name("gaussian");
    FAIL();
  } catch (const InvalidArgument& error) {
    EXPECT_THAT(error.what(), HasSubstr("'gaussian'"));
    for (const std::string& name : family_names()) EXPECT_THAT(error.what(), HasSubstr(name));
  }
}

TEST(Generators, OtherDimensionsAreAInvalidArgument) {
  EXPECT_THROW(make_generator({Family::kUniform, 10, 7, 1}), InvalidArgument);
  EXPECT_THROW(make_generator({Family::kTerrain, 10, 1, 1}), InvalidArgument);
}

}  // namespace
}  // namespace spillway::test
