// What a tree of tiles needs to go on in another process.

#include <utility>
#include <vector>

#include "formats/state/state_reader.h"
#include "formats/state/state_writer.h"
#include "stream/tiles/tile_tree.h"

namespace spillway::detail {

template <typename State>
void TileTree::state(State& state) {
  state.section("tiles");
  state(sketches_, cuts_, cuts_made_, tiles_, cell_roots_, cell_done_, regions_begun_);
  std::vector<NumberedTile> taken;
  if constexpr (State::kReads) {
    state(taken);
    taken_.clear();
    for (NumberedTile& tile : taken) taken_.emplace(tile.number, std::move(tile.tile));
  } else {
    for (auto& [number, tile] : taken_) taken.push_back({number, std::move(tile)});
    state(taken);
    for (NumberedTile& tile : taken) taken_[tile.number] = std::move(tile.tile);
  }
  state(left_over_, left_over_points_, dealing_again_, dealt_again_, batches_, arrivals_, runs_,
        capacity_, points_, segments_, points_written_, bytes_written_, divided_, filled_);
  if constexpr (State::kReads) {
    room_ = 0;
    for (const Tile& tile : tiles_) room_ += tile.room();
  }
}

template void TileTree::state(StateReader&);
template void TileTree::state(StateWriter&);

}  // namespace spillway::detail
