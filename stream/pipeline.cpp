#include "stream/pipeline.h"

#include <fmt/format.h>

#include <memory>
#include <mutex>
#include <utility>

#include "src/delaunay/base_case/base_case.h"
#include "src/error.h"
#include "src/geometry/lattice_check.h"
#include "src/parallel/parallel.h"
#include "stream/plan/memory_plan.h"
#include "stream/source/false_header.h"
#include "stream/tiles/regions/region_plan.h"
#include "stream/triangulate/tile_engine.h"

namespace spillway::detail {
namespace {

/// How full cells of a plan are meant to get, of what a tile may have: densities differ.
constexpr double kMostFill = 0.8;

/// Points of a source as a tree of tiles takes them.
PointFeed feed_of(PointStream& source, const StreamOptions& options, StageTimes& times) {
  return {.fetch =
              [&](SourcePiece& piece) {
                StageTimer timer(times, Stage::kRead, StepOrder::kInOrder);
                options.progress(source.points_read(), source.fraction_read());
                const bool fetched = source.fetch(piece);
                if (!piece.raw.unread) timer.move_bytes(piece.raw.bytes.size());
                return fetched;
              },
          .decode =
              [&](SourcePiece& piece, PointBlock& block) {
                StageTimer timer(times, Stage::kRead);
                if (piece.raw.unread) timer.move_bytes(piece.raw.bytes.size());
                source.decode(piece, block);
              }};
}

template <int D>
void divide(TileEngine<D>& engine, const StreamOptions& options) {
  if (!engine.is_to_divide()) return;
  options.begin_phase("divide");
  options.end_phase(engine.divide_large());
}

/// The next phase begins, with a checkpoint if that is due.
template <int D>
void begin(EnginePhase phase, TileEngine<D>& engine, const StreamOptions& options) {
  if (engine.phase() == phase) return;
  engine.begin_phase(phase);
  if (options.checkpoints != nullptr && options.checkpoints->due_at_end_of_phase()) engine.save();
}

template <int D>
void run(TileEngine<D>& engine, PointStream& source, MemoryBudget& budget,
         const StreamOptions& options) {
  if (engine.phase() == EnginePhase::kSpill) {
    options.begin_phase("read");
    engine.spill(feed_of(source, options, engine.times()));
    options.end_phase(source.points_read());
    begin(EnginePhase::kDivide, engine, options);
  }
  if (engine.phase() == EnginePhase::kDivide) divide(engine, options);
  options.begin_phase("triangulate");
  const std::optional<TileNode<D>>& root = engine.take_nodes();
  if (!root) refuse_empty_input(source.counts());
  refuse_flat_points(engine.span(), engine.points());
  // A sink that went on has it already.
  if (engine.phase() != EnginePhase::kTriangulate) {
    options.extent_known(plane_of(root->box), root->points);
  }
  if constexpr (D == 2) budget.set_enough(enough_memory<D>(root->points, options.record_size));
  begin(EnginePhase::kTriangulate, engine, options);
  engine.triangulate(*root, {});
  options.end_phase(engine.points());
}

/// The box around the points of a feed, seen by many threads.
class SeenExtent {
 public:
  [[nodiscard]] PointFeed watched(PointFeed feed) {
    return {
        .fetch = std::move(feed.fetch),
        .decode = [this, decode = std::move(feed.decode)](SourcePiece& piece, PointBlock& block) {
          decode(piece, block);
          const Box<2> box = plane_of(box_around(block.points));
          const std::lock_guard lock(mutex_);
          box_.expand(box);
        }};
  }

  /// When all is read.
  [[nodiscard]] const Box<2>& box() const { return box_; }

  template <typename State>
  void state(State& state) {
    state(box_);
  }

 private:
  std::mutex mutex_;  ///< guards the next one
  Box<2> box_;
};

/// What headers tell, as far as a run goes by it.
struct Trust {
  std::optional<RegionPlan> plan{};  ///< by which tiles are complete early
  std::optional<Box<2>> extent{};    ///< on which early blocks rely

  /// How far it went in a process before this one, by which it is found again.
  template <typename State>
  void state(State& state) {
    state.section("trust");
    bool planned = plan.has_value();
    state(planned, extent);
    if (State::kReads && !planned) plan.reset();
  }
};

/// Triangulates while it reads. Throws FalseHeader if a point lies elsewhere, or if all together do
/// not have the extent on which blocks rely.
template <int D>
void run_early(TileEngine<D>& engine, PointStream& source, MemoryBudget& budget,
               const StreamOptions& options, const std::optional<Box<2>>& extent,
               SeenExtent& seen) {
  if constexpr (D == 2) {
    budget.set_enough(enough_memory<D>(source.expected().value_or(0), options.record_size));
  }
  if (engine.phase() == EnginePhase::kSpill) {
    options.begin_phase("read");
    PointFeed feed = feed_of(source, options, engine.times());
    engine.spill(extent ? seen.watched(std::move(feed)) : std::move(feed));
    options.end_phase(source.points_read());
    begin(EnginePhase::kDivide, engine, options);
  }
  if (engine.points() == 0) refuse_empty_input(source.counts());
  if (extent && *extent != seen.box() && !options.extent_holds(seen.box())) {
    throw FalseHeader(
        Error("the points cannot be read again, and headers tell another extent than theirs",
              ErrorCode::kBadInput, {.remedy = Remedy::kDistrustHeaders}),
        "headers tell another extent than that of the points",
        FalseHeader::Extent{seen.box(), engine.points()});
  }
  if (engine.phase() == EnginePhase::kDivide) divide(engine, options);
  options.begin_phase("triangulate");
  refuse_flat_points(engine.span(), engine.points());
  begin(EnginePhase::kTriangulate, engine, options);
  options.end_phase(engine.triangulate_rest());
}

/// With a plan by which tiles are complete while other points are still to be read; without, if the
/// source does not tell where its points lie, or if too few tiles would be complete early; or if it
/// does not tell an extent where one is needed.
Trust trust_in(PointStream& source, int dimension, const MemoryBudget& budget,
               const StreamOptions& options) {
  if (!options.early || source.regions().empty()) return {};
  std::size_t capacity = options.tile_capacity;
  if (capacity == 0) {
    const MemoryPlan memory = plan_memory(budget.limit(), dimension, options.threads,
                                          budget.whole(), true, options.record_size);
    capacity = tile_capacity_for(source.expected().value_or(0), memory);
  }
  Trust trust;
  trust.plan =
      plan_regions(source.regions(), {.dimension = dimension,
                                      .most_points = kMostFill * static_cast<double>(capacity),
                                      .any_order = source.any_order()});
  if (!pays(*trust.plan)) return {};
  if (options.needs_extent) {
    trust.extent = source.told_extent();
    if (!trust.extent || !options.extent_told(*trust.extent, source.expected().value_or(0))) {
      return {};
    }
  }
  source.keep_to(*trust.plan);
  return trust;
}

/// What of a run outlives the process.
template <int D>
struct RunState {
  TileEngine<D>& engine;
  PointStream& source;
  BlockSink& sink;
  Trust& trust;
  SeenExtent& seen;

  void save(StateWriter& state) const {
    state(trust, seen, engine);
    source.save(state);
    sink.save(state);
  }
  /// All but the trust.
  void restore(StateReader& state) const {
    state(seen, engine);
    source.restore(state);
    sink.restore(state);
  }
};

/// Points that do not come again are read to their end before there is a checkpoint.
template <int D>
void keep_checkpoints(RunState<D> run, Checkpoints& checkpoints) {
  run.engine.rest_for(
      {.due =
           [&checkpoints, run, again = run.source.goes_on()] {
             return (again || run.engine.phase() != EnginePhase::kSpill) && checkpoints.due();
           },
       .save = [&checkpoints,
                run] { checkpoints.save([&run](StateWriter& state) { run.save(state); }); }});
}

/// Goes on from `restored`, if it is set, which is used up.
template <int D>
RunFigures run_once(PointStream& source, BlockSink& sink, ScratchFolder& scratch,
                    MemoryBudget& budget, const StreamOptions& options, Trust& trust,
                    std::unique_ptr<StateReader>& restored) {
  TileEngine<D> engine({.lattice = source.lattice(),
                        .count = source.expected(),
                        .extent = source.extent(),
                        .plan = trust.plan ? &*trust.plan : nullptr},
                       sink, scratch, budget, options);
  SeenExtent seen;
  const RunState<D> state{engine, source, sink, trust, seen};
  if (options.checkpoints != nullptr) keep_checkpoints(state, *options.checkpoints);
  with_threads(engine.threads(), [&] {
    if (restored) {
      state.restore(*restored);
      options.checkpoints->folder().restored(*restored);
      restored.reset();
    }
    if (trust.plan) {
      run_early(engine, source, budget, options, trust.extent, seen);
    } else {
      run(engine, source, budget, options);
    }
  });
  release_base_case_memory();
  if (options.trace != nullptr) options.trace->end({.tasks = engine.task_sums()});
  return engine.figures();
}

/// As far as it went when the checkpoint was made.
void restore_trust(StateReader& state, PointStream& source, Trust& trust) {
  const bool planned = trust.plan.has_value();
  state(trust);
  if (planned && !trust.plan) source.read_again(false);
}

/// Leaves of the trust what has held, and returns where blocks go now; nullptr if points or blocks
/// are gone for good.
BlockSink* begin_again(const FalseHeader& found, PointStream& source, const StreamOptions& options,
                       Trust& trust) {
  const std::uint64_t read = source.points_read();
  const bool boxes_hold = found.extent().has_value();
  if (!source.read_again(boxes_hold)) return nullptr;
  BlockSink* const sink = options.begin_again();
  if (sink == nullptr) return nullptr;
  release_base_case_memory();
  if (!boxes_hold) options.end_phase(read);
  options.warn(fmt::format("{}: all points are read again{}", found.finding(),
                           boxes_hold ? "" : " before any is triangulated"));
  if (boxes_hold) {
    trust.extent = found.extent()->box;
    options.extent_known(found.extent()->box, found.extent()->points);
  } else {
    trust = {};
  }
  return sink;
}

}  // namespace

template <int D>
RunFigures triangulate_stream(PointStream& source, BlockSink& sink, ScratchFolder& scratch,
                              MemoryBudget& budget, const StreamOptions& options) {
  const MemoryLease inputs(budget, source.known_bytes(), "what is known of the inputs");
  std::unique_ptr<StateReader> restored =
      options.checkpoints != nullptr ? options.checkpoints->folder().open_checkpoint() : nullptr;
  Trust trust = trust_in(source, D, budget, options);
  if (restored) restore_trust(*restored, source, trust);
  for (BlockSink* blocks = &sink;;) {
    try {
      return run_once<D>(source, *blocks, scratch, budget, options, trust, restored);
    } catch (const FalseHeader& found) {
      if (options.checkpoints != nullptr) options.checkpoints->folder().forget_checkpoint();
      blocks = begin_again(found, source, options, trust);
      if (blocks == nullptr) throw;
    }
  }
}

void refuse_empty_mesh(const RunFigures& figures, const std::optional<double>& max_edge) {
  if (figures.mesh.simplices > 0) return;
  throw Error(fmt::format("every one of {} simplices has an edge longer than {}: nothing is left",
                          figures.left_out, max_edge.value_or(0)),
              ErrorCode::kDegenerateInput);
}

template RunFigures triangulate_stream<2>(PointStream&, BlockSink&, ScratchFolder&, MemoryBudget&,
                                          const StreamOptions&);
template RunFigures triangulate_stream<3>(PointStream&, BlockSink&, ScratchFolder&, MemoryBudget&,
                                          const StreamOptions&);

}  // namespace spillway::detail
