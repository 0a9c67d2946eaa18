// The contract over several ranks: each rank's view is exactly what it should hold of the one
// triangulation that a single process computes, neighbours and all.

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

namespace spillway::detail::distributed {
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

  [[nodiscard]] std::vector<Point<D>> own() const {
    return {points.begin() + first[world().rank()], points.begin() + first[world().rank() + 1]};
  }
  [[nodiscard]] VertexId number(RankIndex name) const { return first[name.rank] + name.index; }
};

/// A simplex by the numbers of its points, sorted, with what it has beyond each facet, in the same
/// order, and its orientation.
template <int D>
struct KnownSimplex {
  std::array<VertexId, D + 1> corners;
  std::array<VertexId, D + 1> beyond;
  bool even = true;

  KnownSimplex(const std::array<VertexId, D + 1>& unsorted,
               const std::array<VertexId, D + 1>& unsorted_beyond)
      : corners(unsorted), beyond(unsorted_beyond) {
    for (int i = 0; i <= D; ++i) {
      for (int j = D; j > i; --j) {
        if (corners[j - 1] <= corners[j]) continue;
        std::swap(corners[j - 1], corners[j]);
        std::swap(beyond[j - 1], beyond[j]);
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
      : triangulation(spillway::detail::delaunay<D>(points, {.threads = 1})) {
    const auto number = [&](VertexId v) {
      return v == kInfiniteVertex ? v : triangulation.input_index[v];
    };
    CanonicalHash<D> canonical;
    triangulation.for_each_simplex([&](SimplexId id, const Simplex<D>& simplex) {
      std::array<VertexId, D + 1> corners;
      std::array<VertexId, D + 1> beyond;
      std::array<Point<D>, D + 1> positions;
      for (int i = 0; i <= D; ++i) {
        corners[i] = number(simplex.vertices[i]);
        for (const VertexId v : triangulation.simplex(triangulation.neighbour(id, i)).vertices) {
          if (std::ranges::find(simplex.vertices, v) == simplex.vertices.end()) {
            beyond[i] = number(v);
          }
        }
        if (!simplex.infinite()) positions[i] = points[corners[i]];
      }
      if (!simplex.infinite()) canonical.add(positions);
      simplices.emplace(corners, beyond);
    });
    for (const Duplicate& duplicate : triangulation.duplicates) {
      duplicates[number(duplicate.dropped)] = number(duplicate.kept);
    }
    hash = canonical.value();
  }
};

/// What is wrong with this rank's view, one line a kind of fault.
template <int D>
class ViewCheck {
 public:
  ViewCheck(const View<D>& view, const Deal<D>& deal, const Expected<D>& expected)
      : view_(view), deal_(deal), expected_(expected) {}

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
    return v == kInfiniteVertex ? v : deal_.number(view_.origins[v]);
  }

  void check_vertices() {
    require(view_.dimension == expected_.triangulation.dimension, "another dimension");
    require(view_.names.size() == view_.points.size() &&
                view_.origins.size() == view_.points.size() && view_.own <= view_.points.size(),
            "lists of vertices of different lengths");
    std::vector<VertexId> own(view_.own);
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
    for (VertexId v = 0; v < view_.points.size(); ++v) {
      const RankIndex name = view_.names[v];
      const bool is_own = name.rank == static_cast<std::uint32_t>(world().rank());
      require(is_own == (v < view_.own), "own and foreign vertices mixed");
      require(!is_own || name.index == v, "an own vertex with another number as its name");
      require(name.rank < owned.size() && name.index < owned[name.rank].size() &&
                  owned[name.rank][name.index] == number(v),
              "a vertex whose owner knows it as another one");
      require(view_.points[v] == deal_.points[number(v)], "a vertex at another position");
      require(!expected_.duplicates.contains(number(v)), "a duplicate as a vertex");
    }
    std::array<std::uint64_t, 1> duplicates{view_.duplicates.size()};
    world().reduce(duplicates, Reduction::kSum);
    require(duplicates[0] == expected_.duplicates.size(), "another number of duplicates");
    for (const auto& [dropped, kept] : view_.duplicates) {
      const auto found = expected_.duplicates.find(deal_.number(dropped));
      require(found != expected_.duplicates.end() && found->second == deal_.number(kept),
              "another duplicate");
    }
    own_.insert(own.begin(), own.end());
  }

  void check_simplices() {
    std::set<KnownSimplex<D>> seen;
    std::vector<bool> occurs(view_.points.size());
    const auto occurring = [&](VertexId v) {
      if (v != kInfiniteVertex) occurs[v] = true;
    };
    for (const Simplex<D>& simplex : view_.simplices) {
      std::array<VertexId, D + 1> corners;
      std::array<VertexId, D + 1> beyond;
      for (int i = 0; i <= D; ++i) {
        corners[i] = number(simplex.vertices[i]);
        beyond[i] = number(view_.beyond(simplex, i));
        occurring(simplex.vertices[i]);
        occurring(view_.beyond(simplex, i));
        check_neighbour(simplex, i);
      }
      seen.emplace(corners, beyond);
    }
    require(seen.size() == view_.simplices.size(), "a simplex twice");
    std::set<KnownSimplex<D>> wanted;
    for (const KnownSimplex<D>& simplex : expected_.simplices) {
      if (std::ranges::any_of(simplex.corners, [&](VertexId v) { return own_.contains(v); })) {
        wanted.insert(simplex);
      }
    }
    require(seen == wanted, "other simplices or neighbours than expected");
    require(std::all_of(occurs.begin() + static_cast<std::ptrdiff_t>(view_.own), occurs.end(),
                        [](bool occurs_somewhere) { return occurs_somewhere; }),
            "a foreign vertex that occurs nowhere");
  }

  /// A neighbour in the view points back; one elsewhere has no own vertex.
  void check_neighbour(const Simplex<D>& simplex, int i) {
    if (View<D>::local(simplex, i)) {
      const Simplex<D>& other = view_.simplices[simplex.neighbours[i]];
      const auto back = std::ranges::find_if(other.neighbours, [&](std::uint32_t n) {
        return n < Simplex<D>::kLink && &view_.simplices[n] == &simplex;
      });
      require(back != other.neighbours.end(), "a neighbour that does not point back");
      return;
    }
    for (int k = 0; k <= D; ++k) {
      const VertexId v = k == i ? view_.beyond(simplex, i) : simplex.vertices[k];
      require(v >= view_.own, "a neighbour said to be elsewhere that has an own vertex");
    }
  }

  /// Each simplex counted by the owner of its vertex of the least name.
  void check_hash() {
    CanonicalHash<D> hash;
    for (const Simplex<D>& simplex : view_.simplices) {
      if (simplex.infinite()) continue;
      std::array<Point<D>, D + 1> positions;
      RankIndex least = view_.names[simplex.vertices[0]];
      for (int i = 0; i <= D; ++i) {
        positions[i] = view_.points[simplex.vertices[i]];
        least = std::min(least, view_.names[simplex.vertices[i]]);
      }
      if (least.rank == static_cast<std::uint32_t>(world().rank())) hash.add(positions);
    }
    std::array<std::uint64_t, 1> sum{hash.value()};
    world().reduce(sum, Reduction::kSum);
    require(sum[0] == expected_.hash, "another canonical hash");
  }

  const View<D>& view_;
  const Deal<D>& deal_;
  const Expected<D>& expected_;
  std::set<VertexId> own_;
  std::set<std::string> faults_;
};

template <int D>
void expect_views_of_sequential(const std::vector<Point<D>>& points, Dealing dealing,
                                std::size_t gather_below) {
  SCOPED_TRACE(testing::Message() << points.size() << " points, dealing "
                                  << static_cast<int>(dealing) << ", gathered below "
                                  << gather_below);
  const Deal<D> deal(points, dealing);
  const View<D> view = delaunay<D>(deal.own(), world(), {.gather_below = gather_below});
  const Expected<D> expected(deal.points);
  ASSERT_THAT(ViewCheck<D>(view, deal, expected).faults(), testing::IsEmpty());
}

constexpr std::size_t kAlwaysRecursive = 0;
constexpr std::size_t kAlwaysGathered = 1'000'000;

class DistributedFamily : public testing::TestWithParam<FamilyCase> {
 protected:
  template <int D>
  static void expect_same(std::uint64_t count) {
    const auto points = [&](std::uint64_t n, std::uint64_t seed) {
      return generate_points<D>({GetParam().family, n, D, seed});
    };
    expect_views_of_sequential<D>(points(count, 1), Dealing::kAtRandom, kAlwaysRecursive);
    expect_views_of_sequential<D>(points(count, 2), Dealing::kSkewed, count / 8);
    expect_views_of_sequential<D>(points(count / 5, 3), Dealing::kLastRank, kAlwaysGathered);
  }
};

TEST_P(DistributedFamily, GivesTheViewsOfTheSequentialTriangulation) {
  const bool dense = GetParam().family == Family::kLines;  // in space n^2/4 tetrahedra
  if (GetParam().dimension == 2) {
    expect_same<2>(1500);
  } else {
    expect_same<3>(dense ? 120 : 500);
  }
}

INSTANTIATE_TEST_SUITE_P(Families, DistributedFamily, testing::ValuesIn(all_family_cases()),
                         family_case_name);

template <typename Dimension>
class DistributedDelaunay : public testing::Test {
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

using Dimensions = testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 3>>;
TYPED_TEST_SUITE(DistributedDelaunay, Dimensions);

TYPED_TEST(DistributedDelaunay, TakesFewerPointsThanRanksAndNoneAtAll) {
  for (const std::size_t n : {0, 1, 2, 3, 4, 5, 7, 9, 12}) {
    const auto points = TestFixture::random_integers(n, {100, 100, 100}, n);
    for (const Dealing dealing : {Dealing::kShares, Dealing::kLastRank}) {
      expect_views_of_sequential<TestFixture::kD>(points, dealing, kAlwaysRecursive);
    }
  }
}

TYPED_TEST(DistributedDelaunay, MakesEqualPointsOfDifferentRanksOneVertex) {
  for (std::uint64_t seed = 0; seed < 12; ++seed) {
    const unsigned side = 1 + static_cast<unsigned>(seed % 6);
    const auto points = TestFixture::random_integers(10 + 6 * seed, {side, side, side}, seed);
    expect_views_of_sequential<TestFixture::kD>(points, Dealing::kAtRandom,
                                                seed % 2 == 0 ? kAlwaysRecursive : 10);
  }
}

TYPED_TEST(DistributedDelaunay, TakesPartsThatAreSingleLinesOrPlanes) {
  for (std::uint64_t seed = 0; seed < 4; ++seed) {
    for (const auto extent : {std::array{3U, 40U, 40U}, {2U, 2U, 300U}, {40U, 2U, 1U}}) {
      const auto points = TestFixture::random_integers(200, extent, seed);
      expect_views_of_sequential<TestFixture::kD>(points, Dealing::kAtRandom,
                                                  seed % 2 == 0 ? kAlwaysRecursive : 60);
    }
  }
}

TYPED_TEST(DistributedDelaunay, RecursesThroughSeveralLevelsOfBorders) {
  const auto points = generate_points<TestFixture::kD>(
      {Family::kUniform, TestFixture::kD == 2 ? 12'000U : 2'000U, TestFixture::kD, 9});
  expect_views_of_sequential<TestFixture::kD>(points, Dealing::kAtRandom, kAlwaysRecursive);
}

TYPED_TEST(DistributedDelaunay, GivesEveryRankAboutAsManyVertices) {
  constexpr std::size_t kCount = 16'000;
  const auto points =
      generate_points<TestFixture::kD>({Family::kUniform, kCount, TestFixture::kD, 9});
  const Deal<TestFixture::kD> deal(points, Dealing::kLastRank);
  const auto view = delaunay<TestFixture::kD>(deal.own(), world());
  const double share = static_cast<double>(kCount) / world().size();
  EXPECT_NEAR(static_cast<double>(view.own), share, 0.05 * share);
}

}  // namespace
}  // namespace spillway::detail::distributed
