// Every point of the inputs is in one piece, which at least one rank can fetch.

#include "stream/ranks/exchange/piece_table.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

#include "src/runtime/packing.h"
#include "tests/stream/ranks/shared_inputs.h"

namespace spillway::test {
namespace {

/// A table and what it needs.
struct Table {
  explicit Table(const std::vector<std::string>& paths, const JoinedInputsOptions& options = {})
      : source(open_shared_source(disk(), paths, options, world())) {}

  std::unique_ptr<JoinedInputs> source;
  std::unique_ptr<ScratchFolder> scratch = make_scratch_folder(::testing::TempDir(), std::nullopt);
  StageTimes times;
  std::uint64_t told = 0;
  PieceTable pieces{*source, world(), *scratch, times, [this] { ++told; }};
};

/// The points of a piece, in their order.
PointBlock read(PieceTable& pieces, std::uint64_t piece) {
  PointBlock all;
  PointBlock block;
  for (SourcePiece& batch : pieces.fetch(piece)) {
    pieces.decode(batch, block);
    all.points.insert(all.points.end(), block.points.begin(), block.points.end());
    all.index.insert(all.index.end(), block.index.begin(), block.index.end());
  }
  return all;
}

/// Expects that all pieces in their order, read by ranks that can, are these points.
void expect_points(PieceTable& pieces, const std::vector<LatticePoint>& expected) {
  Packer packer;
  for (std::uint64_t p = 0; p < pieces.size(); ++p) {
    const int reader = pieces.owner(p).value_or(static_cast<int>(p) % world().size());
    if (reader != world().rank()) continue;
    const PointBlock block = read(pieces, p);
    packer.put(p);
    packer.put_list(block.points);
    packer.put_list(block.index);
  }
  std::vector<PointBlock> of_piece(pieces.size());
  for (const auto& bytes : world().gather(packer.bytes())) {
    for (Unpacker unpacker(bytes); !unpacker.empty();) {
      PointBlock& block = of_piece.at(unpacker.take<std::uint64_t>());
      block.points = unpacker.take_list<std::vector<LatticePoint>>();
      block.index = unpacker.take_list<std::vector<std::uint64_t>>();
    }
  }
  std::vector<LatticePoint> points;
  for (const PointBlock& block : of_piece) {
    std::vector<std::uint64_t> index(block.size());
    std::iota(index.begin(), index.end(), pieces.numbered() ? points.size() : 0);
    EXPECT_EQ(block.index, index);
    points.insert(points.end(), block.points.begin(), block.points.end());
  }
  EXPECT_TRUE(points == expected) << points.size() << " of " << expected.size();
}

TEST(PieceTable, OfFilesIsForAnyRank) {
  const SharedFolder folder;
  const auto points = points_of_seed(200'000, 1);
  Table table(write_inputs(folder, points, 2, "npy"));
  EXPECT_GT(table.pieces.size(), 2U);
  EXPECT_TRUE(table.pieces.numbered());
  EXPECT_EQ(table.told, 0U) << "nothing is read beforehand";
  for (std::uint64_t p = 0; p < table.pieces.size(); ++p) EXPECT_FALSE(table.pieces.owner(p));
  expect_points(table.pieces, points);
  world().barrier();
}

TEST(PieceTable, OfInputsThatAreReadFromTheFrontSharesThemOut) {
  const SharedFolder folder;
  const auto points = points_of_seed(150'000, 2);
  Table table(write_inputs(folder, points, 3, "spp"));
  std::vector<int> owners;
  for (std::uint64_t p = 0; p < table.pieces.size(); ++p) {
    ASSERT_TRUE(table.pieces.owner(p));
    owners.push_back(*table.pieces.owner(p));
  }
  for (int input = 0; input < 3; ++input) {
    EXPECT_THAT(owners, ::testing::Contains(input % world().size()));
  }
  const bool is_owner = std::find(owners.begin(), owners.end(), world().rank()) != owners.end();
  EXPECT_EQ(table.told > 0, is_owner);
  expect_points(table.pieces, points);
  world().barrier();
}

TEST(PieceTable, OfTextCountsFromTheBeginningOfAPiece) {
  const SharedFolder folder;
  const auto points = points_of_seed(40'000, 3);
  const std::vector<LatticePoint> more = points_of_seed(10, 4);
  Table table({write_text(folder, points, "a.txt"), write_text(folder, more, "b.txt")});
  EXPECT_FALSE(table.pieces.numbered());
  std::vector<LatticePoint> all = points;
  all.insert(all.end(), more.begin(), more.end());
  expect_points(table.pieces, all);
  world().barrier();
}

TEST(PieceTable, OfThinnedInputsIsWithRankZero) {
  const SharedFolder folder;
  const auto points = points_of_seed(30'000, 5);
  JoinedInputsOptions options;
  options.dimension = 2;
  const auto scratch = make_scratch_folder(::testing::TempDir(), std::nullopt);
  options.thinning =
      ThinningRequest{.cell = 0.1, .memory = std::uint64_t{16} << 20, .scratch = scratch.get()};
  Table table(write_inputs(folder, points, 2, "npy"), options);
  EXPECT_TRUE(table.pieces.numbered());
  std::uint64_t kept = 0;
  for (std::uint64_t p = 0; p < table.pieces.size(); ++p) {
    EXPECT_EQ(table.pieces.owner(p), 0);
    if (world().rank() == 0) kept += read(table.pieces, p).size();
  }
  EXPECT_EQ(kept, world().rank() == 0 ? 100U : 0U) << "one a cell";
  world().barrier();
}

}  // namespace
}  // namespace spillway::test
