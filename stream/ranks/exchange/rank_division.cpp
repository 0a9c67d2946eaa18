#include "stream/ranks/exchange/rank_division.h"

#include <algorithm>
#include <span>

#include "src/runtime/packing.h"

namespace spillway::detail {
namespace {

/// Pieces that are looked at, at least if there are as many: all of them, for small inputs. More
/// for many ranks, each of which takes part.
constexpr std::uint64_t kSampledPieces = 64;
constexpr std::uint64_t kSampledPiecesPerRank = 16;
/// Points of the whole sample.
constexpr std::uint64_t kSample = 1 << 16;
constexpr std::uint64_t kSamplePerRank = 256;
constexpr std::uint64_t kPointsOfPiece = 65'536;

/// Every n-th point of some pieces: those of this rank.
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
      for (std::size_t i = 0; i < block.points.size(); i += step) sample.push_back(block.points[i]);
    }
  }
  // Pieces may be larger than usual: chunks of LAZ have any size.
  std::uint64_t total = sample.size();
  ranks.reduce(std::span(&total, 1), distributed::Reduction::kSum);
  const std::uint64_t more = 1 + total / (2 * std::max(kSample, kSamplePerRank * size));
  std::vector<LatticePoint> thinned;
  for (std::size_t i = 0; i < sample.size(); i += more) thinned.push_back(sample[i]);
  return thinned;
}

void number_ranks(const CutTree& cuts, CutTree::NodeRef ref, int& next, std::vector<int>& ranks) {
  if (CutTree::is_tile(ref)) {
    ranks[CutTree::tile_at(ref)] = next++;
    return;
  }
  for (const CutTree::NodeRef side : cuts.sides(ref)) number_ranks(cuts, side, next, ranks);
}

}  // namespace

std::optional<Box<3>> RankDivision::cell_of(int rank) const {
  const auto tile = std::ranges::find(rank_of_tile, rank);
  if (tile == rank_of_tile.end()) return std::nullopt;
  return cuts.cell(static_cast<std::uint32_t>(tile - rank_of_tile.begin()));
}

RankDivision divide_among_ranks(PieceTable& pieces, int dimension,
                                const distributed::Ranks& ranks) {
  const std::vector<LatticePoint> own = own_sample(pieces, ranks);
  std::vector<LatticePoint> sample;
  for (const auto& bytes : ranks.gather(std::as_bytes(std::span(own)))) {
    const std::size_t before = sample.size();
    sample.resize(before + bytes.size() / sizeof(LatticePoint));
    std::copy(bytes.begin(), bytes.end(),
              std::as_writable_bytes(std::span(sample).subspan(before)).begin());
  }
  RankDivision division{CutTree(dimension), {}};
  division.cuts.split(0, sample, static_cast<std::size_t>(ranks.size()));
  division.rank_of_tile.resize(division.cuts.tiles());
  int next = 0;
  number_ranks(division.cuts, division.cuts.root(), next, division.rank_of_tile);
  return division;
}

}  // namespace spillway::detail
