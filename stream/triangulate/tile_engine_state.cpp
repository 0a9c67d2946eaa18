// How an engine comes to rest, and what it needs to go on in another process.

#include <utility>

#include "formats/state/state_reader.h"
#include "formats/state/state_writer.h"
#include "src/geometry/dimensions.h"
#include "stream/triangulate/tile_engine.h"

namespace spillway::stream {

/// Not before one whose tile has left the tree, nor where blocks of a later one wait for its own.
template <int D>
bool TileEngine<D>::rests_before(const Node& node) const {
  return &node != read_ahead_ && node.number > last_begun_ && resting_.rest_is_due();
}

template <int D>
void TileEngine<D>::save() {
  if (beside_ != nullptr) lanes_.come_to_rest(*beside_);
  held_points_.give_back(tree_.spill_complete());
  resting_.save();
  raise(last_begun_, sequencer_.slots_written());  // the next node comes before another rest
  if (beside_ != nullptr) lanes_.work_beside(*beside_);
}

/// The node was done in a process before this one.
template <int D>
void TileEngine<D>::take_kept_border(Node& node) {
  node.border = nodes_before_.take_border(node.number);
  counts_.borders.add(node.border.simplices.size(), node.border.bytes());
  node.outside = {};
  if (!node.children.empty()) node.kept = {};
  forest_.done(node);
}

/// Tells the cells that were complete in a process before this one.
template <int D>
void TileEngine<D>::add_restored_cells() {
  if (!std::exchange(has_restored_cells_, false)) return;
  for (CompleteCell<D>& cell : std::exchange(complete_cells_, {})) {
    add_cell(cell.cell, std::move(cell.tiles));
  }
}

template <int D>
template <typename State>
void TileEngine<D>::state(State& state) {
  state.section("engine");
  state(span_, seen_, counts_, statistics_.final_by_level, statistics_.first_block_read_points,
        statistics_.divided_points, tree_, sequencer_, root_, complete_cells_);
  if (State::kReads || forest_.empty()) {  // those of before are still to be added
    state(nodes_before_);
    has_restored_cells_ = State::kReads || has_restored_cells_;
  } else if constexpr (!State::kReads) {
    std::uint32_t done = sequencer_.slots_written();
    std::uint64_t kept = 0;
    forest_.visit_left_over([&](const Node&) { ++kept; });
    state(done, kept);
    forest_.visit_left_over([&](Node& node) { state(node.number, node.border); });
  }
}

#define SPILLWAY_INSTANTIATE(D)                                 \
  template bool TileEngine<D>::rests_before(const Node&) const; \
  template void TileEngine<D>::save();                          \
  template void TileEngine<D>::take_kept_border(Node&);         \
  template void TileEngine<D>::add_restored_cells();            \
  template void TileEngine<D>::state(StateReader&);             \
  template void TileEngine<D>::state(StateWriter&);
SPILLWAY_FOR_EACH_DIMENSION(SPILLWAY_INSTANTIATE)
#undef SPILLWAY_INSTANTIATE

}  // namespace spillway::stream
