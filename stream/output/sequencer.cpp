#include "stream/output/sequencer.h"

#include <stdexcept>
#include <utility>

#include "formats/state/state_reader.h"
#include "formats/state/state_writer.h"
#include "src/geometry/dimensions.h"

namespace spillway::stream {
namespace {

std::uint64_t table_bytes(std::uint64_t blocks) {
  return sizeof(std::vector<std::uint64_t>) + blocks * sizeof(std::uint64_t);
}

}  // namespace

template <int D>
Sequencer<D>::Sequencer(BlockSink& sink, MemoryBudget& budget, const OutputOptions& output,
                        StageTimes& times)
    : sink_(sink), budget_(budget), times_(times), counts_facets_(output.max_edge.has_value()) {}

template <int D>
Sequencer<D>::~Sequencer() {
  budget_.give_back(table_bytes_);
}

template <int D>
void Sequencer<D>::open_slot(std::uint32_t slot, std::uint32_t blocks) {
  const std::uint64_t bytes = table_bytes(blocks);
  budget_.take(bytes, "the table of blocks");
  const std::lock_guard lock(mutex_);
  table_bytes_ += bytes;
  if (first_vertex_.size() <= slot) first_vertex_.resize(slot + 1);
  first_vertex_[slot].resize(blocks);
}

template <int D>
void Sequencer<D>::submit(BlockPlace place, MeshStreamBlock mesh, std::vector<StreamPlace> imported,
                          const CanonicalHash<D>& hash) {
  const std::uint64_t vertices = mesh.vertices.size();
  const std::uint64_t simplices = mesh.corners.size() / (D + 1);
  Waiting waiting{std::move(mesh), std::move(imported), {}, vertices, simplices};
  if (counts_facets_) waiting.corners = waiting.mesh.corners;
  {
    const StageTimer timer(times_, Stage::kEncode);
    sink_.absorb(waiting.mesh);
  }
  waiting.bytes = waiting.mesh.bytes() + waiting.imported.size() * sizeof(StreamPlace) +
                  waiting.corners.size() * sizeof(std::uint32_t);
  std::unique_lock lock(mutex_);
  hash_.add(hash);
  waiting_bytes_ += waiting.bytes;
  waiting_.emplace(place, std::move(waiting));
  if (!writing_) write_what_is_due(lock);
}

/// One thread writes at a time; the others go on, and leave it what they have submitted. After an
/// error nothing is written any more.
template <int D>
void Sequencer<D>::write_what_is_due(std::unique_lock<std::mutex>& lock) {
  writing_ = true;
  for (auto due = waiting_.find(next_); due != waiting_.end(); due = waiting_.find(next_)) {
    Waiting turn = std::move(due->second);
    waiting_.erase(due);
    number(turn);
    lock.unlock();
    const std::uint64_t bytes = turn.bytes;
    write(std::move(turn));
    lock.lock();
    waiting_bytes_ -= bytes;
    if (++next_.block == first_vertex_[next_.slot].size()) next_ = {next_.slot + 1, 0};
    turned_.notify_all();
  }
  writing_ = false;
}

template <int D>
void Sequencer<D>::wait_for_room(std::uint64_t bytes, std::uint32_t slot) {
  std::unique_lock lock(mutex_);
  turned_.wait(lock, [&] { return given_up_ || waiting_bytes_ <= bytes || next_.slot >= slot; });
}

template <int D>
void Sequencer<D>::give_up() {
  const std::lock_guard lock(mutex_);
  given_up_ = true;
  turned_.notify_all();
}

/// Numbers the vertices that come with the next block, and those that it has from others. Under the
/// mutex.
template <int D>
void Sequencer<D>::number(Waiting& waiting) {
  first_vertex_[next_.slot][next_.block] = vertices_;
  std::vector<std::uint64_t>& imported = waiting.mesh.imported;
  imported.reserve(waiting.imported.size());
  for (const StreamPlace& place : waiting.imported) imported.push_back(number_of_written(place));
}

template <int D>
void Sequencer<D>::write(Waiting&& waiting) {
  StageTimer timer(times_, Stage::kWrite, StepOrder::kInOrder);
  timer.move_bytes(waiting.bytes);
  MeshStreamBlock& mesh = waiting.mesh;
  if (counts_facets_) {
    open_facets_.add_block(waiting.corners, {vertices_, waiting.vertices, mesh.imported});
  }
  vertices_ += waiting.vertices;
  simplices_ += waiting.simplices;
  const bool empty = waiting.vertices == 0 && waiting.simplices == 0 && mesh.imported.empty();
  if (empty) return;
  if (tell_first_block_) std::exchange(tell_first_block_, {})();
  sink_.write(std::move(mesh));
}

template <int D>
std::uint64_t Sequencer<D>::number_of_written(const StreamPlace& place) const {
  return first_vertex_[place.block.slot][place.block.block] + place.vertex;
}

template <int D>
std::uint64_t Sequencer<D>::number_of(const StreamPlace& place) const {
  const std::lock_guard lock(mutex_);
  return number_of_written(place);
}

template <int D>
MeshTotals Sequencer<D>::totals() const {
  const std::lock_guard lock(mutex_);
  MeshTotals totals;
  totals.vertices = vertices_;
  totals.simplices = simplices_;
  totals.hull_facets = open_facets_.count();
  totals.canonical_hash = hash_.value();
  return totals;
}

template <int D>
std::uint32_t Sequencer<D>::slots_written() const {
  const std::lock_guard lock(mutex_);
  return next_.slot;
}

template <int D>
template <typename State>
void Sequencer<D>::state(State& state) {
  if (!waiting_.empty() || next_.block != 0) {
    throw std::logic_error("blocks wait for others when a state is saved: a fault of the program");
  }
  state.section("sequence of blocks");
  if constexpr (!State::kReads) first_vertex_.resize(next_.slot);
  state(next_, first_vertex_, vertices_, simplices_, hash_, open_facets_);
  if constexpr (State::kReads) {
    if (vertices_ > 0 || simplices_ > 0) tell_first_block_ = nullptr;
    std::uint64_t bytes = 0;
    for (const auto& blocks : first_vertex_) bytes += table_bytes(blocks.size());
    budget_.take(bytes, "the table of blocks");
    table_bytes_ += bytes;
  }
}

#define SPILLWAY_INSTANTIATE(D)                    \
  template void Sequencer<D>::state(StateReader&); \
  template void Sequencer<D>::state(StateWriter&); \
  template class Sequencer<D>;
SPILLWAY_FOR_EACH_DIMENSION(SPILLWAY_INSTANTIATE)
#undef SPILLWAY_INSTANTIATE

}  // namespace spillway::stream
