// The contract over several ranks: their shares together are the one triangulation that a single
// process computes, each simplex once, at the rank that owns its vertex of the least name.

#include "src/distributed/delaunay.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <map>
#include <numeric>
#include <random>
#include <set>
#include <string>

#include "src/delaunay/delaunay.h"
#include "src/distributed/items.h"
#include "src/geometry/canonical_hash.h"
#include "tests/distributed/world.h"
#include "tests/generators/family_cases.h"

namespace spillway::test {
namespace {

/// Which rank gives which points.
enum class Dealing {
  kShares,    ///< stretches of the input, one for each rank
  kAtRandom,  ///< each point to some rank
  kLastRank,  ///< all to one rank, nothing to the others
  kSkewed,    ///< to each rank about a third of what the one before has; none to odd ranks
};

int rank_of(Dealing dealing, std::size_t i, std::size_t count) {
  const auto ranks = static_cast<std::size_t>(world().size());
  std::mt19937_64 random(i);
  switch (dealing) {
    case Dealing::kShares:
      return static_cast<int>(i * ranks / count);
    case Dealing::kAtRandom:
      return static_cast<int>(random() % ranks);
    case Dealing::kLastRank:
      return world().size() - 1;
    case Dealing::kSkewed: {
      std::size_t rank = 0;
      while (rank + 2 < ranks && random() % 3 == 0) rank += 2;
      return static_cast<int>(rank);
    }
  }
  return 0;
}

/// All points, ordered by the ranks that give them: name p is number first[p.rank] + p.index.
template <int D>
struct Deal {
  std::vector<Point<D>> points;
  std::vector<VertexId> first{0};

  Deal(const std::vector<Point<D>>& input, Dealing dealing) {
    std::vector<std::vector<Point<D>>> parts(world().size());
    for (std::size_t i = 0; i < input.size(); ++i) {
      parts[rank_of(dealing, i, input.size())].push_back(input[i]);
    }
    for (const auto& part : parts) {
      points.insert(points.end(), part.begin(), part.end());
      first.push_back(static_cast<VertexId>(points.size()));
    }
  }

  [[nodiscard]] std::vector<NamedPoint<D>> own() const {
    const auto rank = static_cast<std::uint32_t>(world().rank());
    std::vector<NamedPoint<D>> own;
    for (VertexId i = first[rank]; i < first[rank + 1]; ++i) {
      own.push_back({points[i], {rank, i - first[rank]}});
    }
    return own;
  }
  [[nodiscard]] VertexId number(RankIndex name) const { return first[name.rank] + name.index; }
};

/// A simplex by the numbers of its points, sorted, and its orientation.
template <int D>
struct KnownSimplex {
  std::array<VertexId, D + 1> corners;
  bool even = true;

  explicit KnownSimplex(const std::array<VertexId, D + 1>& unsorted) : corners(unsorted) {
    for (int i = 0; i <= D; ++i) {
      for (int j = D; j > i; --j) {
        if (corners[j - 1] <= corners[j]) continue;
        std::swap(corners[j - 1], corners[j]);
        even = !even;
      }
    }
  }

  // NOLINTNEXTLINE(modernize-use-nullptr): a false finding in what the compiler generates
  auto operator<=>(const KnownSimplex&) const = default;
};

/// The triangulation by a single process, as KnownSimplex.
template <int D>
struct Expected {
  Triangulation<D> triangulation;
  std::set<KnownSimplex<D>> simplices;
  std::map<VertexId, VertexId> duplicates;  ///< dropped -> kept
  std::uint64_t hash = 0;

  explicit Expected(const std::vector<Point<D>>& points)
      : triangulation(delaunay::delaunay_triangulation<D>(points, {.threads = 1})) {
    const auto number = [&](VertexId v) {
      return v == kInfiniteVertex ? v : triangulation.input_index[v];
    };
    CanonicalHash<D> canonical;
    triangulation.for_each_simplex([&](SimplexId, const Simplex<D>& simplex) {
      std::array<VertexId, D + 1> corners;
      std::array<Point<D>, D + 1> positions;
      for (int i = 0; i <= D; ++i) {
        corners[i] = number(simplex.vertices[i]);
        if (!simplex.infinite()) positions[i] = points[corners[i]];
      }
      if (!simplex.infinite()) canonical.add(positions);
      simplices.emplace(corners);
    });
    for (const DroppedDuplicate& duplicate : triangulation.duplicates) {
      duplicates[number(duplicate.dropped)] = number(duplicate.kept);
    }
    hash = canonical.value();
  }
};

/// What is wrong with this rank's share, one line a kind of fault.
template <int D>
class ShareCheck {
 public:
  ShareCheck(const Share<D>& share, const Deal<D>& deal, const Expected<D>& expected)
      : share_(share), deal_(deal), expected_(expected) {}

  std::set<std::string> faults() {
    check_vertices();
    if (faults_.empty()) check_simplices();
    check_hash();
    return faults_;
  }

 private:
  void require(bool holds, const std::string& what) {
    if (!holds) faults_.insert(what);
  }
  [[nodiscard]] VertexId number(VertexId v) const {
    return v == kInfiniteVertex ? v : deal_.number(share_.origins[v]);
  }

  void check_vertices() {
    require(share_.dimension == expected_.triangulation.dimension, "another dimension");
    require(share_.names.size() == share_.points.size() &&
                share_.origins.size() == share_.points.size() && share_.own <= share_.points.size(),
            "lists of vertices of different lengths");
    std::vector<VertexId> own(share_.own);
    for (VertexId v = 0; v < own.size(); ++v) own[v] = number(v);
    std::vector<std::vector<VertexId>> owned;
    std::set<VertexId> all;
    std::size_t total = 0;
    for (const auto& bytes : world().gather(std::as_bytes(std::span(own)))) {
      owned.push_back(items_of<VertexId>(bytes));
      all.insert(owned.back().begin(), owned.back().end());
      total += owned.back().size();
    }
    require(all.size() == total, "a vertex with two owners");
    require(total == expected_.triangulation.vertex_count(), "vertices without an owner");
    for (VertexId v = 0; v < share_.points.size(); ++v) {
      const RankIndex name = share_.names[v];
      const bool is_own = name.rank == static_cast<std::uint32_t>(world().rank());
      require(is_own == (v < share_.own), "own and foreign vertices mixed");
      require(!is_own || name.index == v, "an own vertex with another number as its name");
      require(name.rank < owned.size() && name.index < owned[name.rank].size() &&
                  owned[name.rank][name.index] == number(v),
              "a vertex whose owner knows it as another one");
      require(share_.points[v] == deal_.points[number(v)], "a vertex at another position");
      require(!expected_.duplicates.contains(number(v)), "a duplicate as a vertex");
    }
    std::array<std::uint64_t, 1> duplicates{share_.duplicates.size()};
    world().reduce(duplicates, Reduction::kSum);
    require(duplicates[0] == expected_.duplicates.size(), "another number of duplicates");
    for (const auto& [dropped, kept] : share_.duplicates) {
      const auto found = expected_.duplicates.find(deal_.number(dropped));
      require(found != expected_.duplicates.end() && found->second == deal_.number(kept),
              "another duplicate");
    }
  }

  /// Of all shares together each is there once, and where it belongs.
  void check_simplices() {
    std::set<KnownSimplex<D>> seen;
    std::vector<bool> occurs(share_.points.size());
    for (const auto& simplex : share_.simplices) {
      std::array<VertexId, D + 1> corners;
      RankIndex least = kInfiniteName;
      for (int i = 0; i <= D; ++i) {
        corners[i] = number(simplex[i]);
        if (simplex[i] == kInfiniteVertex) continue;
        occurs[simplex[i]] = true;
        least = std::min(least, share_.names[simplex[i]]);
      }
      require(least.rank == static_cast<std::uint32_t>(world().rank()),
              "a simplex that another rank should hold");
      require(expected_.simplices.contains(KnownSimplex<D>(corners)), "a simplex too many");
      seen.emplace(corners);
    }
    require(seen.size() == share_.simplices.size(), "a simplex twice");
    std::array<std::uint64_t, 1> all{seen.size()};
    world().reduce(all, Reduction::kSum);
    require(all[0] == expected_.simplices.size(), "another number of simplices");
    require(std::all_of(occurs.begin() + static_cast<std::ptrdiff_t>(share_.own), occurs.end(),
                        [](bool occurs_somewhere) { return occurs_somewhere; }),
            "a foreign vertex that occurs nowhere");
  }

  void check_hash() {
    CanonicalHash<D> hash;
    for (const auto& simplex : share_.simplices) {
      if (std::ranges::find(simplex, kInfiniteVertex) != simplex.end()) continue;
      std::array<Point<D>, D + 1> positions;
      for (int i = 0; i <= D; ++i) positions[i] = share_.points[simplex[i]];
      hash.add(positions);
    }
    std::array<std::uint64_t, 1> sum{hash.value()};
    world().reduce(sum, Reduction::kSum);
    require(sum[0] == expected_.hash, "another canonical hash");
  }

  const Share<D>& share_;
  const Deal<D>& deal_;
  const Expected<D>& expected_;
  std::set<std::string> faults_;
};

/// Messages of at most so many bytes.
template <int D>
Share<D> delaunay_of(const Deal<D>& deal, std::size_t gather_below, std::size_t largest_message) {
  const auto triangulate = [](std::vector<Point<D>> points) {
    return delaunay::delaunay_triangulation<D>(points, {.threads = 1});
  };
  return distributed::delaunay_triangulation<D>(deal.own(), world(),
                                                {.triangulate = triangulate,
                                                 .gather_below = gather_below,
                                                 .limits = {.largest_message = largest_message}});
}

template <int D>
void expect_shares_of_sequential(const std::vector<Point<D>>& points, Dealing dealing,
                                 std::size_t gather_below) {
  SCOPED_TRACE(::testing::Message()
               << points.size() << " points, dealing " << static_cast<int>(dealing)
               << ", gathered below " << gather_below);
  const Deal<D> deal(points, dealing);
  const Share<D> share = delaunay_of(deal, gather_below, points.size() % 2 == 0 ? 500 : 1U << 20U);
  const Expected<D> expected(deal.points);
  ASSERT_THAT(ShareCheck<D>(share, deal, expected).faults(), ::testing::IsEmpty());
}

constexpr std::size_t kAlwaysRecursive = 0;
constexpr std::size_t kAlwaysGathered = 1'000'000;

class DistributedFamily : public ::testing::TestWithParam<FamilyCase> {
 protected:
  template <int D>
  static void expect_same(std::uint64_t count) {
    const auto points = [&](std::uint64_t n, std::uint64_t seed) {
      return generated_points<D>({GetParam().family, n, D, seed});
    };
    expect_shares_of_sequential<D>(points(count, 1), Dealing::kAtRandom, kAlwaysRecursive);
    expect_shares_of_sequential<D>(points(count, 2), Dealing::kSkewed, count / 8);
    expect_shares_of_sequential<D>(points(count / 5, 3), Dealing::kLastRank, kAlwaysGathered);
  }
};

TEST_P(DistributedFamily, GivesSharesOfTheSequentialTriangulation) {
  const bool dense = GetParam().family == Family::kLines;  // in space n^2/4 tetrahedra
  if (GetParam().dimension == 2) {
    expect_same<2>(1500);
  } else {
    expect_same<3>(dense ? 120 : 500);
  }
}

INSTANTIATE_TEST_SUITE_P(Families, DistributedFamily, ::testing::ValuesIn(all_family_cases()),
                         family_case_name);

template <typename Dimension>
class DistributedDelaunay : public ::testing::Test {
 protected:
  static constexpr int kD = Dimension::value;

  static std::vector<Point<kD>> random_integers(std::size_t n, std::array<unsigned, 3> extent,
                                                std::uint64_t seed) {
    std::mt19937_64 random(seed);
    std::vector<Point<kD>> points(n);
    for (auto& p : points) {
      for (int k = 0; k < kD; ++k) p[k] = static_cast<double>(random() % extent[k]);
    }
    return points;
  }
};

using Dimensions = ::testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 3>>;
TYPED_TEST_SUITE(DistributedDelaunay, Dimensions);

TYPED_TEST(DistributedDelaunay, TakesFewerPointsThanRanksAndNoneAtAll) {
  for (const std::size_t n : {0, 1, 2, 3, 4, 5, 7, 9, 12}) {
    const auto points = TestFixture::random_integers(n, {100, 100, 100}, n);
    for (const Dealing dealing : {Dealing::kShares, Dealing::kLastRank}) {
      expect_shares_of_sequential<TestFixture::kD>(points, dealing, kAlwaysRecursive);
    }
  }
}

TYPED_TEST(DistributedDelaunay, MakesEqualPointsOfDifferentRanksOneVertex) {
  for (std::uint64_t seed = 0; seed < 12; ++seed) {
    const unsigned side = 1 + static_cast<unsigned>(seed % 6);
    const auto points = TestFixture::random_integers(10 + 6 * seed, {side, side, side}, seed);
    expect_shares_of_sequential<TestFixture::kD>(points, Dealing::kAtRandom,
                                                 seed % 2 == 0 ? kAlwaysRecursive : 10);
  }
}

TYPED_TEST(DistributedDelaunay, TakesPartsThatAreSingleLinesOrPlanes) {
  for (std::uint64_t seed = 0; seed < 4; ++seed) {
    for (const auto extent : {std::array{3U, 40U, 40U}, {2U, 2U, 300U}, {40U, 2U, 1U}}) {
      const auto points = TestFixture::random_integers(200, extent, seed);
      expect_shares_of_sequential<TestFixture::kD>(points, Dealing::kAtRandom,
                                                   seed % 2 == 0 ? kAlwaysRecursive : 60);
    }
  }
}

TYPED_TEST(DistributedDelaunay, RecursesThroughSeveralLevelsOfBorders) {
  const auto points = generated_points<TestFixture::kD>(
      {Family::kUniform, TestFixture::kD == 2 ? 12'000U : 2'000U, TestFixture::kD, 9});
  expect_shares_of_sequential<TestFixture::kD>(points, Dealing::kAtRandom, kAlwaysRecursive);
}

TYPED_TEST(DistributedDelaunay, GivesEveryRankAboutAsManyVertices) {
  constexpr std::size_t kCount = 16'000;
  const auto points =
      generated_points<TestFixture::kD>({Family::kUniform, kCount, TestFixture::kD, 9});
  const Deal<TestFixture::kD> deal(points, Dealing::kLastRank);
  const auto share = delaunay_of(deal, 100'000, 1U << 20U);
  const double wanted = static_cast<double>(kCount) / world().size();
  EXPECT_NEAR(static_cast<double>(share.own), wanted, 0.05 * wanted);
}

}  // namespace
}  // namespace spillway::test
