#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <span>
#include <vector>

#include "src/distributed/ranks.h"
#include "src/runtime/stage_times.h"
#include "stream/ranks/exchange/piece_table.h"
#include "stream/ranks/exchange/rank_division.h"

namespace spillway::ranks {

/// How many pieces may be on their way at a time.
struct ExchangeRound {
  std::uint64_t pieces_of_rank = 1;  ///< that a rank reads
  std::uint64_t pieces = 1;          ///< that all read, since all may be for one rank
};

/// Moves all points to their ranks, in rounds: in each a rank reads some of its pieces, and sends
/// what is for others. Each rank reads a stretch of the inputs, so that inputs in spatial order,
/// too, have points for many ranks in a round. Points come to a rank in any order; their indices
/// are in the order of the inputs.
class PointExchange : public PointFeed {
 public:
  /// Collective. `indexed`: points come with their indices. All others must outlive it.
  PointExchange(PieceTable& pieces, const RankDivision& division, const distributed::Ranks& ranks,
                const ExchangeRound& most, bool indexed, StageTimes& times);

  /// From now on all ranks come to rest after a round if this is true at one of them.
  void rest_when(std::function<bool()> due) { rest_due_ = std::move(due); }
  /// Whether this rank is to come to rest before it fetches more. Then rested() is to be called.
  [[nodiscard]] bool rests() const { return rests_ && arrived_.empty(); }
  void rested() { rests_ = false; }

  /// What another process needs to go on, at rest.
  template <typename State>
  void state(State& state) {
    state.section("exchange");
    state(next_own_, round_, records_, points_sent_);
  }

  /// Calls this after each round.
  void tell_rounds(std::function<void()> told) { round_done_ = std::move(told); }

  /// Takes the next points of this rank. Collective, in that all ranks call it until it is false.
  /// True, but without points, if rests().
  bool fetch(SourcePiece& piece) override;
  void decode(SourcePiece& piece, PointBlock& block) override;

  /// The share of all rounds that is done.
  [[nodiscard]] double fraction() const;
  [[nodiscard]] std::uint64_t points_sent() const { return points_sent_; }

  /// Where pieces are not numbered(), indices name a piece and a record in it until all is read.
  /// Then this gives what it takes to count them through all inputs: the records before each piece.
  /// Collective.
  [[nodiscard]] std::vector<std::uint64_t> records_before();

 private:
  /// A piece that this rank reads in this round.
  struct OwnPiece {
    std::uint64_t number = 0;
    std::vector<SourcePiece> batches;
    std::vector<PointBlock> kept;                  ///< by batch: points of this rank
    std::vector<std::vector<std::byte>> for_rank;  ///< by rank, packed batches of blocks
    std::uint64_t sent = 0;                        ///< points
  };
  /// Points for this rank: ready, or as blocks that are still to be decoded.
  struct Arrived {
    PointBlock block;
    std::vector<std::byte> bytes;
  };

  void choose_own_pieces();
  void next_round();
  void agree_to_rest();
  [[nodiscard]] bool is_all_own(const PointBlock& block) const;
  void deal(OwnPiece& piece) const;
  void send(std::vector<OwnPiece>& own);

  PieceTable& pieces_;
  const RankDivision& division_;
  const distributed::Ranks& ranks_;
  const std::optional<Box<3>> own_cell_;
  const bool indexed_;
  StageTimes& times_;
  std::uint64_t pieces_per_round_ = 1;
  std::uint64_t turns_ = 1;         ///< a rank reads in one round of this many
  std::vector<std::uint64_t> own_;  ///< pieces that this rank reads
  std::uint64_t next_own_ = 0;
  std::uint64_t round_ = 0;
  std::uint64_t rounds_ = 0;
  std::vector<std::uint64_t> records_;  ///< by piece; only of this rank's
  std::uint64_t points_sent_ = 0;
  std::deque<Arrived> arrived_;
  std::function<bool()> rest_due_;
  std::function<void()> round_done_ = [] {};
  bool rests_ = false;
};

/// Puts indices that count through all inputs in place of those that name pieces.
void count_through(std::span<std::uint64_t> index, std::span<const std::uint64_t> records_before);

}  // namespace spillway::ranks
