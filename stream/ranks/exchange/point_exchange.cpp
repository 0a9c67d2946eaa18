#include "stream/ranks/exchange/point_exchange.h"

#include <algorithm>
#include <numeric>
#include <optional>
#include <span>
#include <utility>

#include "src/parallel/parallel.h"
#include "src/runtime/packing.h"
#include "stream/points/encoded_points.h"
#include "stream/tiles/cuts/dealt_points.h"

namespace spillway::ranks {
namespace {

/// An index that is not counted through all inputs: the number of a piece, then that of a record.
constexpr unsigned kRecordBits = 36;
constexpr std::uint64_t kRecordMask = (std::uint64_t{1} << kRecordBits) - 1;

}  // namespace

PointExchange::PointExchange(PieceTable& pieces, const RankDivision& division,
                             const distributed::Ranks& ranks, const ExchangeRound& most,
                             bool indexed, StageTimes& times)
    : pieces_(pieces),
      division_(division),
      ranks_(ranks),
      own_cell_(division.cell_of(ranks.rank())),
      indexed_(indexed),
      times_(times),
      pieces_per_round_(most.pieces_of_rank) {
  const auto size = static_cast<std::uint64_t>(ranks.size());
  if (most.pieces < size * pieces_per_round_) {
    pieces_per_round_ = std::max<std::uint64_t>(1, most.pieces / size);
    turns_ = (size + most.pieces - 1) / most.pieces;
  }
  if (!pieces_.numbered()) records_.resize(pieces_.size());
  choose_own_pieces();
}

/// Of the pieces that any rank can read, a stretch; and those that only this one can.
void PointExchange::choose_own_pieces() {
  const auto size = static_cast<std::uint64_t>(ranks_.size());
  const auto rank = static_cast<std::uint64_t>(ranks_.rank());
  std::uint64_t shared = 0;
  for (std::uint64_t p = 0; p < pieces_.size(); ++p) shared += pieces_.owner(p) ? 0 : 1;
  const std::uint64_t begin = shared * rank / size;
  const std::uint64_t end = shared * (rank + 1) / size;
  std::uint64_t place = 0;  // among those that are shared
  for (std::uint64_t p = 0; p < pieces_.size(); ++p) {
    const std::optional<int> owner = pieces_.owner(p);
    const bool is_own = owner ? *owner == ranks_.rank() : place >= begin && place < end;
    if (is_own) own_.push_back(p);
    if (!owner) ++place;
  }
  rounds_ = (own_.size() + pieces_per_round_ - 1) / pieces_per_round_ * turns_;
  ranks_.reduce(std::span(&rounds_, 1), distributed::Reduction::kMost);
}

bool PointExchange::fetch(SourcePiece& piece) {
  piece.raw.clear();
  while (arrived_.empty()) {
    if (rests_) return true;
    if (round_ == rounds_) return false;
    next_round();
    agree_to_rest();
    round_done_();
  }
  Arrived next = std::move(arrived_.front());
  arrived_.pop_front();
  piece.raw.decoded = std::move(next.block);
  piece.raw.bytes = std::move(next.bytes);
  return true;
}

void PointExchange::decode(SourcePiece& piece, PointBlock& block) {
  if (piece.raw.bytes.empty()) {
    std::swap(piece.raw.decoded, block);
  } else {
    const StageTimer timer(times_, Stage::kExchange);
    decode_all_points(piece.raw.bytes, {"points from another rank"}, block);
  }
}

double PointExchange::fraction() const {
  return rounds_ == 0 ? 1 : static_cast<double>(round_) / static_cast<double>(rounds_);
}

void PointExchange::next_round() {
  std::vector<OwnPiece> own;
  const bool reads = round_++ % turns_ == static_cast<std::uint64_t>(ranks_.rank()) % turns_;
  while (reads && own.size() < pieces_per_round_ && next_own_ < own_.size()) {
    OwnPiece& piece = own.emplace_back();
    piece.number = own_[next_own_++];
    piece.batches = pieces_.fetch(piece.number);
    if (pieces_.numbered()) continue;
    for (const SourcePiece& batch : piece.batches) {
      records_[piece.number] += batch.raw.records();
    }
  }
  isolated([&] {
    parallel_for(own.size(), 1, [&](std::size_t, std::size_t p, std::size_t) { deal(own[p]); });
  });
  send(own);
}

/// Collective.
void PointExchange::agree_to_rest() {
  if (!rest_due_) return;
  std::uint64_t due = rest_due_() ? 1 : 0;
  ranks_.reduce(std::span(&due, 1), distributed::Reduction::kMost);
  rests_ = due > 0;
}

std::vector<std::uint64_t> PointExchange::records_before() {
  std::vector<std::uint64_t> before = std::move(records_);
  ranks_.reduce(before, distributed::Reduction::kSum);
  std::exclusive_scan(before.begin(), before.end(), before.begin(), std::uint64_t{0});
  return before;
}

void count_through(std::span<std::uint64_t> index, std::span<const std::uint64_t> records_before) {
  for (std::uint64_t& i : index) i = records_before[i >> kRecordBits] + (i & kRecordMask);
}

/// Whether all points are this rank's, as nearly all blocks of an input in spatial order are.
bool PointExchange::is_all_own(const PointBlock& block) const {
  return own_cell_ && std::ranges::all_of(block.points, [this](const LatticePoint& point) {
           bool inside = true;
           for (int k = 0; k < 3; ++k) {
             inside = inside && point[k] >= own_cell_->lo[k] && point[k] < own_cell_->hi[k];
           }
           return inside;
         });
}

/// Reads a piece's points and sorts them by rank; those for others are encoded.
void PointExchange::deal(OwnPiece& piece) const {
  std::vector<Packer> for_rank(static_cast<std::size_t>(ranks_.size()));
  PointBlock block;
  DealtPoints dealt;
  for (SourcePiece& batch : piece.batches) {
    pieces_.decode(batch, block);
    batch = {};
    const StageTimer timer(times_, Stage::kExchange);
    if (!pieces_.numbered()) {
      for (std::uint64_t& index : block.index) index |= piece.number << kRecordBits;
    }
    if (is_all_own(block)) {
      if (!indexed_) block.index.clear();
      piece.kept.push_back(std::exchange(block, {}));
      continue;
    }
    dealt.deal(division_.cuts, block);
    for (const PointRun& run : dealt.runs) {
      PointsView points = dealt.points_of(run);
      if (!indexed_) points.index = {};
      const int rank = division_.rank_of_tile[run.tile];
      if (rank == ranks_.rank()) {
        points.append_to(piece.kept.emplace_back());
      } else {
        std::vector<std::byte> bytes;
        append_all_points(bytes, points);
        for_rank[static_cast<std::size_t>(rank)].put_list(bytes);
        piece.sent += points.size();
      }
    }
  }
  for (Packer& packer : for_rank) piece.for_rank.push_back(packer.take());
}

/// Collective.
void PointExchange::send(std::vector<OwnPiece>& own) {
  const StageTimer timer(times_, Stage::kExchange);
  std::vector<distributed::Message> messages;
  for (int rank = 0; rank < ranks_.size(); ++rank) {
    std::vector<std::byte> message;
    for (OwnPiece& piece : own) {
      std::vector<std::byte>& bytes = piece.for_rank[static_cast<std::size_t>(rank)];
      message.insert(message.end(), bytes.begin(), bytes.end());
      bytes = {};
    }
    if (!message.empty()) messages.push_back({rank, std::move(message)});
  }
  for (OwnPiece& piece : own) {
    points_sent_ += piece.sent;
    for (PointBlock& block : piece.kept) arrived_.push_back({std::move(block), {}});
  }
  for (distributed::Message& message : ranks_.exchange(std::move(messages))) {
    const std::vector<std::byte> bytes = std::move(message.bytes);
    for (Unpacker batches(bytes); !batches.empty();) {
      arrived_.push_back({{}, batches.take_list<std::vector<std::byte>>()});
    }
  }
}

}  // namespace spillway::ranks
