// Pieces are decoded by all threads, and their blocks come in the order of the pieces.

#include "stream/source/ordered_blocks.h"

#include <gtest/gtest.h>

#include <chrono>
#include <thread>

#include "src/error.h"
#include "src/parallel/parallel.h"

namespace spillway::test {
namespace {

constexpr std::uint64_t kPieces = 50;

/// Pieces 0, 1, ...: their blocks have their own number as the index of a point.
class NumberedPieces : public PointFeed {
 public:
  bool fetch(SourcePiece& piece) override {
    piece.first_index = next_;
    return next_++ < kPieces;
  }
  void decode(SourcePiece& piece, PointBlock& block) override {
    if (piece.first_index % 3 == 0) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    block.clear();
    block.index.push_back(piece.first_index);
  }

 private:
  std::uint64_t next_ = 0;
};

TEST(OrderedBlocks, ComeInTheOrderOfThePieces) {
  for (const unsigned threads : {1U, 4U}) {
    std::uint64_t taken = 0;
    NumberedPieces pieces;
    with_threads(threads, [&] {
      for_each_block(pieces,
                     [&](const PointBlock& block) { EXPECT_EQ(block.index.at(0), taken++); });
    });
    EXPECT_EQ(taken, kPieces);
  }
}

TEST(OrderedBlocks, AnErrorOfAPieceReachesTheCaller) {
  class CorruptPiece final : public NumberedPieces {
    void decode(SourcePiece& piece, PointBlock& /*block*/) override {
      if (piece.first_index == 20) throw Failure("piece 20 is corrupt");
    }
  } pieces;
  EXPECT_THROW(for_each_block(pieces, [](PointBlock&) {}), Failure);
}

}  // namespace
}  // namespace spillway::test
