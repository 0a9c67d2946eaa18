// Every point gets to its rank once, with an index that tells its place in the inputs.

#include "stream/ranks/exchange/point_exchange.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "formats/disk/private_file.h"
#include "formats/state/state_reader.h"
#include "formats/state/state_writer.h"
#include "src/runtime/packing.h"
#include "tests/stream/ranks/shared_inputs.h"

namespace spillway::test {
namespace {

/// Points on their way from inputs to ranks.
struct Road {
  explicit Road(const std::vector<std::string>& paths)
      : source(open_shared_source(disk(), paths, {.dimension = 2}, world())) {}

  std::unique_ptr<JoinedInputs> source;
  std::unique_ptr<ScratchFolder> scratch = make_scratch_folder(::testing::TempDir(), std::nullopt);
  StageTimes times;
  PieceTable pieces{*source, world(), *scratch, times, [] {}};
  RankDivision division = divide_among_ranks<2>(pieces, world()).division;
};

int rank_of(const RankDivision& division, const LatticePoint& point) {
  std::uint32_t tile = 0;
  division.cuts.find_tiles(std::span(&point, 1), std::span(&tile, 1));
  return division.rank_of_tile.at(tile);
}

struct Arrivals {
  std::uint64_t points = 0;  ///< of all ranks
  std::uint64_t sent = 0;
  int rounds = 0;
};

/// Sends all points, and expects each at its rank, once, with its index.
Arrivals expect_arrival(Road& road, const ExchangeRound& most,
                        const std::vector<LatticePoint>& points) {
  PointExchange exchange(road.pieces, road.division, world(), most, true, road.times);
  Arrivals arrivals;
  std::vector<LatticePoint> here;
  std::vector<std::uint64_t> index;
  double share = exchange.fraction();
  SourcePiece batch;
  PointBlock block;
  exchange.tell_rounds([&] {
    ++arrivals.rounds;
    EXPECT_GT(exchange.fraction(), share);
    share = exchange.fraction();
  });
  while (exchange.fetch(batch)) {
    exchange.decode(batch, block);
    EXPECT_EQ(block.points.size(), block.index.size());
    here.insert(here.end(), block.points.begin(), block.points.end());
    index.insert(index.end(), block.index.begin(), block.index.end());
  }
  EXPECT_EQ(exchange.fraction(), 1);
  if (!road.pieces.numbered()) count_through(index, exchange.records_before());
  for (std::size_t i = 0; i < here.size(); ++i) {
    EXPECT_EQ(rank_of(road.division, here[i]), world().rank());
    EXPECT_EQ(here[i], points.at(index[i]));
  }
  std::vector<std::uint64_t> all;
  for (const auto& bytes : world().gather(std::as_bytes(std::span(index)))) {
    const auto before = all.size();
    all.resize(before + bytes.size() / sizeof(std::uint64_t));
    std::copy(bytes.begin(), bytes.end(),
              std::as_writable_bytes(std::span(all).subspan(before)).begin());
  }
  std::sort(all.begin(), all.end());
  EXPECT_EQ(std::unique(all.begin(), all.end()), all.end()) << "a point came twice";
  arrivals.points = all.size();
  std::uint64_t sent = exchange.points_sent();
  world().reduce(std::span(&sent, 1), distributed::Reduction::kSum);
  arrivals.sent = sent;
  return arrivals;
}

/// Another process goes on where all ranks have come to rest, and nothing comes twice or is lost.
TEST(PointExchange, GoesOnAfterARoundAtWhichAllRanksCameToRest) {
  const SharedFolder folder;
  const auto points = points_of_seed(300'000, 4);
  Road road(write_inputs(folder, points, 2, "npy"));
  const std::string file = folder / ("state" + std::to_string(world().rank()));
  std::uint64_t arrived = 0;
  const auto fetch_until_rest = [&](PointExchange& exchange) {
    SourcePiece batch;
    PointBlock block;
    while (!exchange.rests()) {
      if (!exchange.fetch(batch)) return false;
      exchange.decode(batch, block);
      arrived += block.points.size();
    }
    return true;
  };
  const auto make = [&] {
    auto exchange = std::make_unique<PointExchange>(road.pieces, road.division, world(),
                                                    ExchangeRound{1, 100}, true, road.times);
    // It is enough that one rank wants to.
    exchange->rest_when([] { return world().rank() == 0; });
    return exchange;
  };
  auto exchange = make();
  int rests = 0;
  for (; fetch_until_rest(*exchange); ++rests) {
    StateWriter writer(create_private_file(file, file));
    writer(*exchange);
    writer.finish();
    exchange = make();
    StateReader reader(disk().open(file), file);
    reader(*exchange);
    reader.finish();
  }
  EXPECT_GT(rests, 0);
  world().reduce(std::span(&arrived, 1), distributed::Reduction::kSum);
  EXPECT_EQ(arrived, points.size());
}

TEST(PointExchange, BringsEveryPointToItsRankHoweverFewPiecesAreUnderWay) {
  const SharedFolder folder;
  const auto points = points_of_seed(300'000, 3);
  Road road(write_inputs(folder, points, 2, "npy"));
  int rounds = 0;
  for (const ExchangeRound most : {ExchangeRound{8, 100}, {2, 2}, {1, 1}}) {
    const Arrivals arrivals = expect_arrival(road, most, points);
    EXPECT_EQ(arrivals.points, points.size());
    if (world().size() == 1) {
      EXPECT_EQ(arrivals.sent, 0U);
    } else {
      EXPECT_GT(arrivals.sent, points.size() / 4);
      EXPECT_LT(arrivals.sent, points.size());
    }
    EXPECT_GE(arrivals.rounds, rounds) << "fewer pieces at a time need more rounds";
    rounds = arrivals.rounds;
  }
  world().barrier();
}

TEST(PointExchange, CountsThroughInputsThatDoNotTellTheirNumber) {
  const SharedFolder folder;
  std::vector<LatticePoint> points = points_of_seed(70'000, 4);
  const std::vector<LatticePoint> more = points_of_seed(5000, 5);
  Road road({write_text(folder, points, "a.txt"), write_text(folder, more, "b.txt")});
  ASSERT_FALSE(road.pieces.numbered());
  points.insert(points.end(), more.begin(), more.end());
  EXPECT_EQ(expect_arrival(road, {2, 10}, points).points, points.size());
  world().barrier();
}

TEST(PointExchange, DropsIndicesThatNobodyWants) {
  const SharedFolder folder;
  Road road(write_inputs(folder, points_of_seed(3000, 6), 1, "npy"));
  PointExchange exchange(road.pieces, road.division, world(), {4, 4}, false, road.times);
  SourcePiece batch;
  PointBlock block;
  std::uint64_t points = 0;
  while (exchange.fetch(batch)) {
    exchange.decode(batch, block);
    EXPECT_TRUE(block.index.empty());
    points += block.size();
  }
  world().reduce(std::span(&points, 1), distributed::Reduction::kSum);
  EXPECT_EQ(points, 3000U);
}

}  // namespace
}  // namespace spillway::test
