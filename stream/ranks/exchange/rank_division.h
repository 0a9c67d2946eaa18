#pragma once

#include <vector>

#include "src/distributed/ranks.h"
#include "stream/ranks/exchange/piece_table.h"
#include "stream/tiles/cuts/cut_tree.h"

namespace spillway::detail {

/// Which rank each point belongs to: the top of the k-d tree, one tile for each rank. Ranks are in
/// the order of the tree, so that the ranks below a cut follow each other.
struct RankDivision {
  CutTree cuts;
  std::vector<int> rank_of_tile;  ///< by tile of `cuts`; ranks without a tile get no points
};

/// Divides space so that all ranks get about as many points and borders are small (divide_sample),
/// by a sample of the pieces, which are spread over all inputs. Rank 0 has the sample, and tells
/// the others the cuts. Collective; all ranks get the same.
template <int D>
RankDivision divide_among_ranks(PieceTable& pieces, const distributed::Ranks& ranks);

}  // namespace spillway::detail
