// Pieces are decoded by all threads, and their blocks come in the order of the pieces.

#include "stream/source/ordered_blocks.h"

#include <gtest/gtest.h>

#include <chrono>
#include <thread>

#include "src/error.h"
#include "src/parallel/parallel.h"

namespace spillway::detail {
namespace {

constexpr std::uint64_t kPieces = 50;

/// Pieces 0, 1, ...: their blocks have their own number as the index of a point.
PointFeed numbered_pieces() {
  return {.fetch =
              [next = std::uint64_t{0}](SourcePiece& piece) mutable {
                piece.first_index = next;
                return next++ < kPieces;
              },
          .decode =
              [](SourcePiece& piece, PointBlock& block) {
                if (piece.first_index % 3 == 0) {
                  std::this_thread::sleep_for(std::chrono::milliseconds(1));
                }
                block.clear();
                block.index.push_back(piece.first_index);
              }};
}

TEST(OrderedBlocks, ComeInTheOrderOfThePieces) {
  for (const unsigned threads : {1U, 4U}) {
    std::uint64_t taken = 0;
    with_threads(threads, [&] {
      for_each_block(numbered_pieces(),
                     [&](const PointBlock& block) { EXPECT_EQ(block.index.at(0), taken++); });
    });
    EXPECT_EQ(taken, kPieces);
  }
}

TEST(OrderedBlocks, AnErrorOfAPieceReachesTheCaller) {
  PointFeed feed = numbered_pieces();
  feed.decode = [](SourcePiece& piece, PointBlock&) {
    if (piece.first_index == 20) throw Error("piece 20 is corrupt");
  };
  EXPECT_THROW(for_each_block(feed, [](PointBlock&) {}), Error);
}

}  // namespace
}  // namespace spillway::detail
