#pragma once

#include <condition_variable>
#include <cstdint>
#include <functional>
#include <map>
#include <mutex>
#include <utility>
#include <vector>

#include "formats/meshes/common/mesh_stream.h"
#include "src/geometry/canonical_hash.h"
#include "src/runtime/memory_budget.h"
#include "src/runtime/stage_times.h"
#include "stream/output/output_options.h"
#include "stream/output/stream_place.h"
#include "stream/output/unpaired_facets.h"

namespace spillway::stream {

/// Brings the blocks of leaves and merges, which are ready in any order, into the stream in the
/// order of their places, and numbers the vertices.
template <int D>
class Sequencer {
 public:
  /// `sink`, `budget` and `times` must outlive it. The table of what has been written takes 8 bytes
  /// a block of the budget.
  Sequencer(BlockSink& sink, MemoryBudget& budget, const OutputOptions& output, StageTimes& times);
  ~Sequencer();
  Sequencer(const Sequencer&) = delete;
  Sequencer& operator=(const Sequencer&) = delete;

  /// Is called once, before the first block is written.
  void tell_first_block(std::function<void()> tell) { tell_first_block_ = std::move(tell); }

  /// Tells how many blocks a slot has, at least one; once for every slot, in any order. Throws
  /// Failure (kOutOfBudget) if the table of blocks does not fit into the budget.
  void open_slot(std::uint32_t slot, std::uint32_t blocks);

  /// Takes what settle() made for one block; each comes once, from any thread. The sink absorbs it
  /// at once, in the calling thread.
  void submit(BlockPlace place, MeshStreamBlock mesh, std::vector<StreamPlace> imported,
              const CanonicalHash<D>& hash);

  /// Waits until at most `bytes` bytes of blocks wait for their turn, or until it is the turn of
  /// `slot`, whose blocks nobody else will bring.
  void wait_for_room(std::uint64_t bytes, std::uint32_t slot);

  /// Ends all waiting, now and later, for a run that has failed.
  void give_up();

  /// The number that a vertex has got in the stream; its block has been written.
  [[nodiscard]] std::uint64_t number_of(const StreamPlace& place) const;

  /// The facets of one simplex only, where simplices are left out; once all blocks are written.
  [[nodiscard]] const UnpairedFacets<D>& open_facets() const { return open_facets_; }

  /// How many slots have been written, all of whose blocks have come. What of later slots has come
  /// waits: there may be none of it for state().
  [[nodiscard]] std::uint32_t slots_written() const;
  template <typename State>
  void state(State& state);

  /// Vertices, simplices, hash and, where simplices were left out, hull facets of all blocks.
  [[nodiscard]] MeshTotals totals() const;

 private:
  struct Waiting {
    MeshStreamBlock mesh;
    std::vector<StreamPlace> imported;
    std::vector<std::uint32_t> corners;  ///< the mesh's, if facets are counted
    std::uint64_t vertices = 0;  ///< that the block announces; the mesh may be encoded already
    std::uint64_t simplices = 0;
    std::uint64_t bytes = 0;
  };

  void write_what_is_due(std::unique_lock<std::mutex>& lock);
  void number(Waiting& waiting);
  void write(Waiting&& waiting);
  [[nodiscard]] std::uint64_t number_of_written(const StreamPlace& place) const;

  BlockSink& sink_;
  MemoryBudget& budget_;
  std::uint64_t table_bytes_ = 0;
  std::function<void()> tell_first_block_;  ///< empty once it has been called
  StageTimes& times_;
  mutable std::mutex mutex_;
  std::condition_variable turned_;
  std::map<BlockPlace, Waiting> waiting_;
  std::uint64_t waiting_bytes_ = 0;
  BlockPlace next_{0, 0};
  /// By slot, empty where not known yet, and block: as written.
  std::vector<std::vector<std::uint64_t>> first_vertex_;
  std::uint64_t vertices_ = 0;
  std::uint64_t simplices_ = 0;
  CanonicalHash<D> hash_;
  bool counts_facets_;
  bool given_up_ = false;
  bool writing_ = false;  ///< somebody is, or an error has ended it
  UnpairedFacets<D> open_facets_;
};

}  // namespace spillway::stream
