// What a tree of tiles needs to go on in another process.

#include <utility>
#include <vector>

#include "formats/state/state_reader.h"
#include "formats/state/state_writer.h"
#include "stream/tiles/tile_tree.h"

namespace spillway::detail {
namespace {

using TakenTiles = std::unordered_map<std::uint32_t, Tile>;

void transfer_taken(StateReader& state, TakenTiles& taken) {
  std::vector<NumberedTile> tiles;
  state(tiles);
  taken.clear();
  for (NumberedTile& tile : tiles) taken.emplace(tile.number, std::move(tile.tile));
}

void transfer_taken(StateWriter& state, TakenTiles& taken) {
  std::uint64_t size = taken.size();
  state(size);
  for (auto& [tile_number, tile] : taken) {
    std::uint32_t number = tile_number;
    state(number, tile);
  }
}

}  // namespace

template <typename State>
void TileTree::state(State& state) {
  state.section("tiles");
  state(options_.extent, options_.sample);  // as expect() has told
  state(sketches_, cuts_, cuts_made_, tiles_, cell_roots_, cell_done_, regions_begun_);
  transfer_taken(state, taken_);
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
