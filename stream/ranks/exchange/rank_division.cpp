#include "stream/ranks/exchange/rank_division.h"

#include <algorithm>
#include <span>
#include <utility>

#include "src/delaunay/common/hash.h"
#include "src/distributed/items.h"
#include "src/geometry/dimensions.h"
#include "src/runtime/packing.h"
#include "stream/ranks/exchange/collective_step.h"
#include "stream/tiles/cuts/sample_division.h"

namespace spillway::ranks {
namespace {

/// Pieces that are looked at, at least if there are as many: all of them, for small inputs. More
/// for many ranks, each of which takes part.
constexpr std::uint64_t kSampledPieces = 64;
constexpr std::uint64_t kSampledPiecesPerRank = 16;
/// Points of the whole sample.
constexpr std::uint64_t kSample = 1 << 16;
constexpr std::uint64_t kSamplePerRank = 256;
constexpr std::uint64_t kPointsOfPiece = 65'536;

/// Appends one of every `step` points: not every n-th, since points may have a period, as those
/// that several scanners send in turns.
void take_some(const std::vector<LatticePoint>& points, std::uint64_t step,
               std::vector<LatticePoint>& sample) {
  for (std::uint64_t i = 0; i < points.size(); i += step) {
    sample.push_back(points[std::min(i + mix64(i) % step, points.size() - 1)]);
  }
}

/// Some points of some pieces: those of this rank.
std::vector<LatticePoint> own_sample(PieceTable& pieces, const distributed::Ranks& ranks) {
  const auto size = static_cast<std::uint64_t>(ranks.size());
  const std::uint64_t wanted = std::max(kSampledPieces, kSampledPiecesPerRank * size);
  const std::uint64_t piece_step = std::max<std::uint64_t>(1, pieces.size() / wanted);
  const std::uint64_t points = pieces.size() / piece_step * kPointsOfPiece;
  const std::uint64_t step =
      std::max<std::uint64_t>(1, points / std::max(kSample, kSamplePerRank * size));
  std::vector<LatticePoint> sample;
  PointBlock block;
  for (std::uint64_t p = 0; p < pieces.size(); p += piece_step) {
    const std::optional<int> owner = pieces.owner(p);
    const int reader = owner ? *owner : static_cast<int>(p / piece_step % size);
    if (reader != ranks.rank()) continue;
    for (SourcePiece& batch : pieces.fetch(p)) {
      batch.counted = false;
      pieces.decode(batch, block);
      take_some(block.points, step, sample);
    }
  }
  // Pieces may be larger than usual: chunks of LAZ have any size.
  std::uint64_t total = sample.size();
  ranks.reduce(std::span(&total, 1), distributed::Reduction::kSum);
  const std::uint64_t more = 1 + total / (2 * std::max(kSample, kSamplePerRank * size));
  std::vector<LatticePoint> thinned;
  take_some(sample, more, thinned);
  return thinned;
}

std::vector<LatticePoint> joined(const std::vector<std::vector<std::byte>>& samples) {
  std::vector<LatticePoint> all;
  for (const std::vector<std::byte>& bytes : samples) {
    const std::size_t before = all.size();
    all.resize(before + bytes.size() / sizeof(LatticePoint));
    std::ranges::copy(bytes, std::as_writable_bytes(std::span(all).subspan(before)).begin());
  }
  return all;
}

void number_ranks(const CutTree& cuts, CutTree::NodeRef ref, int& next, std::vector<int>& ranks) {
  if (CutTree::is_tile(ref)) {
    ranks[CutTree::tile_at(ref)] = next++;
    return;
  }
  for (const CutTree::NodeRef side : cuts.sides(ref)) number_ranks(cuts, side, next, ranks);
}

/// The points of the sample that lie in this rank's cell, of what all ranks have of it. Collective.
std::vector<LatticePoint> sample_of_rank(const RankDivision& division,
                                         std::span<const LatticePoint> sample,
                                         const distributed::Ranks& ranks) {
  std::vector<std::uint32_t> tiles(sample.size());
  division.cuts.find_tiles(sample, tiles);
  distributed::ItemsByRank<LatticePoint> by_rank;
  for (std::size_t i = 0; i < sample.size(); ++i) {
    by_rank[division.rank_of_tile[tiles[i]]].push_back(sample[i]);
  }
  std::vector<LatticePoint> own;
  for (const auto& [rank, some] : distributed::exchange_items(ranks, std::move(by_rank), {})) {
    own.insert(own.end(), some.begin(), some.end());
  }
  return own;
}

}  // namespace

std::optional<Box<3>> RankDivision::cell_of(int rank) const {
  const auto tile = std::ranges::find(rank_of_tile, rank);
  if (tile == rank_of_tile.end()) return std::nullopt;
  return cuts.cell(static_cast<std::uint32_t>(tile - rank_of_tile.begin()));
}

template <int D>
DividedSample divide_among_ranks(PieceTable& pieces, const distributed::Ranks& ranks) {
  const std::vector<LatticePoint> own = own_sample(pieces, ranks);
  const auto samples = ranks.gather(std::as_bytes(std::span(own)), 0);
  std::vector<std::byte> bytes;
  run_collective_step(ranks, [&] {
    if (ranks.rank() != 0) return;
    Packer packer;
    packer.put_list(divide_sample<D>(joined(samples), static_cast<std::size_t>(ranks.size())));
    bytes = packer.take();
  });
  ranks.broadcast(bytes, 0);
  RankDivision division{CutTree(D), {}};
  division.cuts.split(0, Unpacker(bytes).take_list<std::vector<DivisionCut>>());
  division.rank_of_tile.resize(division.cuts.tiles());
  int next = 0;
  number_ranks(division.cuts, division.cuts.root(), next, division.rank_of_tile);
  std::vector<LatticePoint> kept = sample_of_rank(division, own, ranks);
  return {std::move(division), std::move(kept)};
}

#define SPILLWAY_INSTANTIATE(D) \
  template DividedSample divide_among_ranks<D>(PieceTable&, const distributed::Ranks&);
SPILLWAY_FOR_EACH_CUT_DIMENSION(SPILLWAY_INSTANTIATE)
#undef SPILLWAY_INSTANTIATE

}  // namespace spillway::ranks
