#pragma once

#include <array>
#include <atomic>
#include <functional>
#include <future>
#include <memory>
#include <mutex>
#include <optional>
#include <vector>

#include "formats/disk/scratch_folder.h"
#include "formats/meshes/common/mesh_stream.h"
#include "src/geometry/box.h"
#include "src/geometry/lattice.h"
#include "src/parallel/parallel.h"
#include "src/runtime/memory_budget.h"
#include "stream/checkpoint/resting.h"
#include "stream/output/sequencer.h"
#include "stream/output/stream_place.h"
#include "stream/plan/memory_plan.h"
#include "stream/plan/run_setup.h"
#include "stream/points/point_span.h"
#include "stream/points/seen_extent.h"
#include "stream/tiles/tile_tree.h"
#include "stream/triangulate/border_growth.h"
#include "stream/triangulate/cell_tree.h"
#include "stream/triangulate/engine_node.h"
#include "stream/triangulate/merge_forest.h"
#include "stream/triangulate/nodes_before.h"
#include "stream/triangulate/sample_forecast.h"
#include "stream/triangulate/task_sums.h"
#include "stream/triangulate/tile_triangulation.h"
#include "stream/triangulate/work_lanes.h"

namespace spillway::stream {

/// What is known of the points to come.
struct ExpectedPoints {
  std::optional<IntegerLattice> lattice{};
  std::optional<std::uint64_t> count{};  ///< about how many
  std::optional<Box<3>> extent{};        ///< where they will lie
  bool ordered_by_index = false;         ///< they come in any order, with an index that tells
  const RegionPlan* plan = nullptr;      ///< to which their feed keeps; must outlive the engine
  bool see_extent = false;               ///< seen_extent() is to be told
};

/// Takes the points of one process from the feed to the border that is left of them: spill(), then
/// divide_large(), then triangulate(). With a plan of the regions that come, spill() triangulates
/// tiles as they are complete, and triangulate_rest() the others. All inside of
/// with_threads(threads()).
template <int D>
class TileEngine : private DealingWatch {
 public:
  /// What is final goes to `blocks`. All but `expected` must outlive it. It comes to rest when
  /// `resting` wants it, for state() to be told.
  TileEngine(const ExpectedPoints& expected, BlockSink& blocks, const RunSetup& setup,
             Resting& resting);
  ~TileEngine() override { budget_.set_estimate({}); }
  TileEngine(const TileEngine&) = delete;
  TileEngine& operator=(const TileEngine&) = delete;

  [[nodiscard]] unsigned threads() const { return plan_.threads; }
  [[nodiscard]] StageTimes& times() { return counts_.times; }

  /// Tells where the points will lie, if it was not known at first. To be called before spill().
  void expect(const Box<3>& extent, std::vector<LatticePoint> sample) {
    tree_.expect(extent, std::move(sample));
  }

  /// Reading it, before any step: of these only those from the one on that was under way are to be
  /// called then.
  template <typename State>
  void state(State& state);
  /// Comes to rest and has the state saved, between two steps or in the midst of one.
  void save() override;

  /// Deals all points of the feed into tiles. With a plan, triangulates tiles that are complete.
  void spill(PointFeed& feed);

  /// After spill(): whether tiles are too large; before take_nodes() their division, which returns
  /// how many points were dealt again.
  [[nodiscard]] bool is_to_divide() const { return tree_.is_to_divide(); }
  std::uint64_t divide_large();

  /// What the points of the feed span, and the box around them.
  [[nodiscard]] const PointSpan<D>& span() const { return span_; }
  [[nodiscard]] const Box<D>& seen_extent() const { return seen_.box(); }

  /// Calls this for the indices of each tile's points when it is loaded, to put others there.
  void replace_indices(std::function<void(std::span<std::uint64_t> index)> replace) {
    replace_indices_ = std::move(replace);
  }

  [[nodiscard]] std::uint64_t points() const { return tree_.points(); }

  /// The tree of tiles; nothing if there are no points.
  [[nodiscard]] const std::optional<TileNode<D>>& take_nodes();

  /// Triangulates the tiles of `root`, one by one, and merges them. What nothing `outside` can
  /// change has gone to the sink when it returns; the rest is returned.
  Border<D> triangulate(const TileNode<D>& root, const Outside<D>& outside);

  /// The same with a plan, for all that is left. Nothing remains. Returns how many points that was.
  std::uint64_t triangulate_rest();

  [[nodiscard]] const OutputOptions& output() const { return context_.output; }

  /// What merges between ranks hold of borders, in place of the border that triangulate() has
  /// returned, or of what was told before; and what they count.
  void hold_border(std::uint64_t simplices, std::uint64_t bytes);
  void count_rank_merge(std::uint32_t level, const Task& task) {
    tasks_.add_merge(TaskScope::kBetweenRanks, level, task);
  }
  void count_retriangulated(std::uint64_t points) { counts_.retriangulated += points; }
  void count_hull_facets(std::uint64_t facets) { counts_.hull_facets += facets; }
  void count_left_out(std::uint64_t simplices) { counts_.left_out += simplices; }
  void count_torus(const TorusProof& proof) { counts_.add(proof); }
  /// Of a periodic domain, once all is triangulated.
  [[nodiscard]] const TorusProof& torus() const { return counts_.torus(); }

  /// The number in the sink's stream of a vertex that has been announced there.
  [[nodiscard]] std::uint64_t number_of(const StreamPlace& place) const {
    return sequencer_.number_of(place);
  }
  /// The open facets of the sink's stream, where simplices are left out.
  [[nodiscard]] const UnpairedFacets<D>& open_facets() const { return sequencer_.open_facets(); }

  /// Of all that has been done; to be called once, at the end.
  [[nodiscard]] RunStatistics statistics();
  [[nodiscard]] std::vector<TaskSum> task_sums() const { return tasks_.sums(); }

 private:
  using Forest = MergeForest<EngineNode<D>>;
  using Node = typename Forest::Node;
  using Lanes = WorkLanes<Node>;

  [[nodiscard]] MemoryPlan plan_for(unsigned threads, bool early) const;
  TileTreeOptions tree_options(const ExpectedPoints& expected);
  void decoded(const PointBlock& points) override;
  [[nodiscard]] std::size_t capacity_for(std::uint64_t points) override;
  void tiles_made(std::size_t tiles) override;
  void cell_done(std::uint32_t cell) override;
  void dealt_again(std::uint64_t points, double fraction) override;
  [[nodiscard]] bool rest_is_due() const override { return resting_.rest_is_due(); }
  [[nodiscard]] std::uint64_t buffer_bytes() const;
  void lease_held_points();
  void begin_triangulating(std::uint64_t points, std::uint64_t all_points);
  void add_cell(std::uint32_t cell);
  void add_cell(std::uint32_t cell, std::optional<TileNode<D>> tiles);
  void add_restored_cells();
  [[nodiscard]] bool rests_before(const Node& node) const;
  Node* add_nodes(const TileNode<D>& tree, const Outside<D>& outside,
                  const std::shared_ptr<const KeptTrees<D>>& kept);
  Node* add_node(EngineNode<D> state, std::vector<Node*> children);
  void take_kept_border(Node& node);
  [[nodiscard]] Lanes make_lanes();
  [[nodiscard]] std::uint64_t loaded_points(const Node& node) const;
  void load(Node& node, const Node* next);
  void work_off(Node& node);
  void tell_points(const TilePoints<D>& points);
  void merge_above(Node& node);
  void give_up();
  void merge_node(Node& node);
  void tell_done(const Node& node, Task task);
  void estimate_shortages(std::uint64_t all_points);
  void report_progress() const;

  const EngineOptions& options_;
  MemoryBudget& budget_;
  RunProgress& progress_;
  Resting& resting_;
  RunSink& sink_;
  const bool tells_points_;  ///< to the sink
  MemoryPlan plan_;
  StreamCounts counts_;
  ShrinkingLease held_points_;  ///< in memory when all are read, until their tile is loaded
  ShrinkingLease sketches_;     ///< of tiles
  PointSpan<D> span_;
  bool grows_capacity_ = false;  ///< of tiles, with the points that come
  const bool sees_extent_;
  SeenExtent<D> seen_;
  const std::uint64_t expected_points_;  ///< 0: not known
  TileTree tree_;
  Sequencer<D> sequencer_;
  TileContext<D> context_;
  Forest forest_;
  Lanes lanes_ = make_lanes();
  TaskGroup* beside_ = nullptr;  ///< what is triangulated while points are read
  std::optional<TileNode<D>> root_;
  NodesBefore<D> nodes_before_;
  std::vector<CompleteCell<D>> complete_cells_;    ///< with a plan, in that order
  bool has_restored_cells_ = false;                ///< which are still to be added
  std::atomic<std::uint32_t> last_begun_ = 0;      ///< the highest number of a node so far
  std::atomic<const Node*> read_ahead_ = nullptr;  ///< its tile has left the tree
  std::optional<CellTree<D>> cells_;               ///< with a plan
  std::vector<Node*> parts_;  ///< of these, by number, as far as they are complete
  Node* top_ = nullptr;       ///< the part that was added last: at the end that of all points
  std::atomic<bool> tells_progress_ = false;  ///< of triangulating: reading has ended
  std::uint64_t points_before_ = 0;           ///< triangulated while points were read
  /// Simplices and bytes of the border that is left at the end, as they are counted.
  std::array<std::uint64_t, 2> left_border_{};
  std::function<void(std::span<std::uint64_t>)> replace_indices_;
  std::mutex load_mutex_;  ///< guards the next one
  std::future<StoredTile> reading_ahead_;
  TaskSums tasks_;
  BorderGrowth<D> growth_;
  SampleForecast<D> sample_;
  std::mutex tell_mutex_;        ///< held while the trace is told a node
  std::mutex statistics_mutex_;  ///< guards the next one
  RunStatistics statistics_;
};

}  // namespace spillway::stream
