#include "stream/output/unpaired_facets.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace spillway::test {
namespace {

using ::testing::ElementsAre;
using ::testing::UnorderedElementsAre;

template <int D>
std::vector<std::array<std::uint64_t, D>> all_of(const UnpairedFacets<D>& facets) {
  return {facets.begin(), facets.end()};
}

TEST(UnpairedFacets, AreThoseOfOneSimplexOnly) {
  UnpairedFacets<2> facets;
  EXPECT_EQ(facets.count(), 0U);
  facets.add({0, 1, 2});
  EXPECT_EQ(facets.count(), 3U);
  facets.add({3, 2, 1});
  using Edge = UnpairedFacets<2>::Facet;
  EXPECT_THAT(all_of<2>(facets),
              UnorderedElementsAre(Edge{0, 1}, Edge{0, 2}, Edge{2, 3}, Edge{1, 3}));
}

TEST(UnpairedFacets, OfABlockAreNamedByTheStream) {
  const std::vector<std::uint64_t> imported = {7};
  const std::vector<std::uint32_t> corners = {0, 1, 2, 3};
  UnpairedFacets<3> facets;
  facets.add_block(corners, StreamNumbers(100, 3, imported));
  using Facet = UnpairedFacets<3>::Facet;
  EXPECT_THAT(all_of<3>(facets), UnorderedElementsAre(Facet{7, 101, 102}, Facet{7, 100, 102},
                                                      Facet{7, 100, 101}, Facet{100, 101, 102}));
}

TEST(UnpairedFacets, ComeAndGo) {
  UnpairedFacets<2> facets;
  facets.toggle({4, 9});
  EXPECT_THAT(all_of<2>(facets), ElementsAre(UnpairedFacets<2>::Facet{4, 9}));
  facets.toggle({4, 9});
  EXPECT_EQ(facets.count(), 0U);
}

}  // namespace
}  // namespace spillway::test
