#pragma once

#include <optional>
#include <vector>

#include "src/distributed/ranks.h"
#include "src/geometry/box.h"
#include "src/geometry/framed_point.h"
#include "stream/ranks/exchange/piece_table.h"
#include "stream/tiles/cuts/cut_tree.h"

namespace spillway::ranks {

/// Which rank each point belongs to: the top of the k-d tree, one tile for each rank. Ranks are in
/// the order of the tree, so that the ranks below a cut follow each other.
struct RankDivision {
  CutTree cuts;
  std::vector<int> rank_of_tile;  ///< by tile of `cuts`; ranks without a tile get no points

  /// Where the points of a rank lie: from `lo` on, below `hi`. Nothing if it gets none.
  [[nodiscard]] std::optional<Box<3>> cell_of(int rank) const;

  template <typename State>
  void state(State& state) {
    state(cuts, rank_of_tile);
  }
};

/// What a rank knows before points are exchanged: the division, the same at all ranks, and a sample
/// of its own points.
struct DividedSample {
  RankDivision division;
  std::vector<LatticePoint> own;
};

/// Divides space so that all ranks get about as many points and borders are small (divide_sample),
/// by a sample of the pieces, which are spread over all inputs. Rank 0 has the sample, and tells
/// the others the cuts. Collective.
template <int D>
DividedSample divide_among_ranks(PieceTable& pieces, const distributed::Ranks& ranks);

}  // namespace spillway::ranks
