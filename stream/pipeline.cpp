#include "stream/pipeline.h"

#include <fmt/format.h>

#include <memory>
#include <utility>

#include "src/delaunay/base_case/base_case.h"
#include "src/error.h"
#include "src/geometry/dimensions.h"
#include "src/geometry/lattice_check.h"
#include "src/parallel/parallel.h"
#include "stream/plan/memory_plan.h"
#include "stream/plan/run_trace.h"
#include "stream/run_phases.h"
#include "stream/source/false_header.h"
#include "stream/tiles/regions/region_plan.h"

namespace spillway::stream {
namespace {

/// How full cells of a plan are meant to get, of what a tile may have: densities differ.
constexpr double kMostFill = 0.8;

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

bool needs_extent(const RunSink& sink, int dimension) {
  return sink.wants_extent() && dimension == 2;
}

/// With a plan by which tiles are complete while other points are still to be read; without, if the
/// source does not tell where its points lie, or if too few tiles would be complete early; or if it
/// does not tell an extent where one is needed.
Trust trust_in(PointStream& source, int dimension, const RunSetup& setup) {
  const EngineOptions& options = setup.options;
  if (!options.asked.trust_headers || source.regions().empty()) return {};
  // Headers do not tell where points lie along axes beyond z.
  if (further_axes(dimension) > 0) return {};
  std::size_t capacity = options.asked.tile_points;
  if (capacity == 0) {
    const MemoryPlan memory = plan_memory(setup.budget.limit(), dimension, options.threads,
                                          setup.budget.whole(), true, options.record_size);
    capacity = tile_points_for(source.expected().value_or(0), memory);
  }
  Trust trust;
  trust.plan =
      plan_regions(source.regions(), {.dimension = dimension,
                                      .most_points = kMostFill * static_cast<double>(capacity),
                                      .any_order = source.any_order()});
  if (!pays(*trust.plan)) return {};
  if (needs_extent(setup.sink, dimension)) {
    trust.extent = source.told_extent();
    if (!trust.extent || !setup.sink.extent_told(*trust.extent, source.expected().value_or(0))) {
      return {};
    }
  }
  source.keep_to(trust.plan->order);
  return trust;
}

/// The points of a source; times how they are read.
class TimedPoints final : public PointFeed {
 public:
  TimedPoints(PointStream& source, RunProgress& progress, StageTimes& times)
      : source_(source), progress_(progress), times_(times) {}

  bool fetch(SourcePiece& piece) override {
    StageTimer timer(times_, Stage::kRead, StepOrder::kInOrder);
    progress_.tell(source_.points_read(), source_.fraction_read());
    const bool fetched = source_.fetch(piece);
    if (!piece.raw.unread) timer.move_bytes(piece.raw.bytes.size());
    return fetched;
  }
  void decode(SourcePiece& piece, PointBlock& block) override {
    StageTimer timer(times_, Stage::kRead);
    if (piece.raw.unread) timer.move_bytes(piece.raw.bytes.size());
    source_.decode(piece, block);
  }

 private:
  PointStream& source_;
  RunProgress& progress_;
  StageTimes& times_;
};

/// A run in one process. With a plan it triangulates while it reads, and throws FalseHeader if a
/// point lies elsewhere, or if all together do not have the extent on which blocks rely.
template <int D>
class RunHere final : public RunPhases<D> {
 public:
  RunHere(PointStream& points, BlockSink& blocks, const RunSetup& with, Trust& trust)
      : RunPhases<D>(points,
                     {.lattice = points.lattice(),
                      .count = points.expected(),
                      .extent = points.extent(),
                      .plan = trust.plan ? &*trust.plan : nullptr,
                      .see_extent = trust.extent.has_value()},
                     blocks, with),
        blocks_(blocks),
        trust_(trust),
        again_(points.goes_on()) {
    if (trust.plan) set_enough(points.expected().value_or(0));
  }

  RunStatistics run(std::unique_ptr<StateReader>& restored) {
    with_threads(this->threads(), [&] {
      if (restored) restore(*std::exchange(restored, nullptr));
      this->walk();
    });
    release_base_case_memory();
    if (this->setup().torus != nullptr) *this->setup().torus = engine().torus();
    if (const auto& trace = options().asked.trace) trace->end({.tasks = engine().task_sums()});
    return engine().statistics();
  }

 private:
  using RunPhases<D>::engine;
  using RunPhases<D>::source;
  using RunPhases<D>::phase;

  [[nodiscard]] const EngineOptions& options() const { return this->setup().options; }

  void set_enough(std::uint64_t points) const {
    if constexpr (D == 2) {
      this->setup().budget.set_enough(enough_memory<D>(points, options().record_size));
    }
  }

  void read() override {
    TimedPoints timed(source(), this->setup().progress, engine().times());
    engine().spill(timed);
    if (!trust_.plan) return;
    if (engine().points() == 0) refuse_empty_input(source().counts());
    if (trust_.extent) check_extent();
  }

  void check_extent() {
    const Box<2> seen = plane_of(engine().seen_extent());
    if (*trust_.extent == seen || this->setup().sink.extent_holds(seen)) return;
    throw FalseHeader(
        Failure("the points cannot be read again, and headers tell another extent than theirs",
                ErrorCode::kBadInput, {.remedy = Remedy::kDistrustHeaders}),
        "headers tell another extent than that of the points",
        FalseHeader::Extent{seen, engine().points()});
  }

  void survey() override {
    if (trust_.plan) return refuse_flat_points(engine().span(), engine().points());
    const std::optional<TileNode<D>>& root = engine().take_nodes();
    if (!root) refuse_empty_input(source().counts());
    refuse_flat_points(engine().span(), engine().points());
    // A sink that went on has it already.
    if (phase() != RunPhase::kTriangulate) {
      this->setup().sink.extent_known(plane_of(root->box), root->points);
    }
    set_enough(root->points);
  }

  std::uint64_t triangulate() override {
    if (trust_.plan) return engine().triangulate_rest();
    engine().triangulate(*engine().take_nodes(), {});
    return engine().points();
  }

  [[nodiscard]] bool saves_before(RunPhase next) const override {
    return next != RunPhase::kSurvey && options().checkpoints != nullptr &&
           options().checkpoints->due_at_end_of_phase();
  }
  /// Points that do not come again are read to their end before there is a checkpoint.
  [[nodiscard]] bool rest_is_due() const override {
    return options().checkpoints != nullptr && (again_ || phase() != RunPhase::kRead) &&
           options().checkpoints->due();
  }
  void save() override {
    options().checkpoints->save([this](StateWriter& state) {
      state(trust_);
      this->state(state);
      source().save(state);
      blocks_.save(state);
    });
  }
  /// All but the trust.
  void restore(StateReader& state) {
    this->state(state);
    source().restore(state);
    blocks_.restore(state);
    options().checkpoints->folder().restored(state);
  }

  BlockSink& blocks_;
  Trust& trust_;
  const bool again_;  ///< the points come again
};

/// As far as it went when the checkpoint was made.
void restore_trust(StateReader& state, PointStream& source, Trust& trust) {
  const bool planned = trust.plan.has_value();
  state(trust);
  if (planned && !trust.plan) source.read_again(false);
}

/// Leaves of the trust what has held, and returns where blocks go now; nullptr if points or blocks
/// are gone for good.
BlockSink* begin_again(const FalseHeader& found, PointStream& source, const RunSetup& setup,
                       Trust& trust) {
  setup.progress.end_phase(source.points_read());
  const bool boxes_hold = found.extent().has_value();
  if (!source.read_again(boxes_hold)) return nullptr;
  BlockSink* const blocks = setup.sink.begin_again();
  if (blocks == nullptr) return nullptr;
  if (const auto& trace = setup.options.asked.trace) trace->begin_again();
  release_base_case_memory();
  setup.progress.warn(fmt::format("{}: all points are read again{}", found.finding(),
                                  boxes_hold ? "" : " before any is triangulated"));
  if (boxes_hold) {
    trust.extent = found.extent()->box;
    setup.sink.extent_known(found.extent()->box, found.extent()->points);
  } else {
    trust = {};
  }
  return blocks;
}

}  // namespace

template <int D>
RunStatistics triangulate_stream(PointStream& source, BlockSink& blocks, const RunSetup& setup) {
  const MemoryLease inputs(setup.budget, source.known_bytes(), "what is known of the inputs");
  Checkpoints* const checkpoints = setup.options.checkpoints;
  std::unique_ptr<StateReader> restored =
      checkpoints != nullptr ? checkpoints->folder().open_checkpoint() : nullptr;
  Trust trust = trust_in(source, D, setup);
  if (restored) restore_trust(*restored, source, trust);
  for (BlockSink* to = &blocks;;) {
    try {
      return RunHere<D>(source, *to, setup, trust).run(restored);
    } catch (const FalseHeader& found) {
      if (checkpoints != nullptr) checkpoints->folder().forget_checkpoint();
      to = begin_again(found, source, setup, trust);
      if (to == nullptr) throw;
    }
  }
}

void refuse_empty_mesh(const RunStatistics& statistics, const std::optional<double>& max_edge) {
  if (statistics.mesh.simplices > 0) return;
  throw Failure(fmt::format("every one of {} simplices has an edge longer than {}: nothing is left",
                            statistics.left_out, max_edge.value_or(0)),
                ErrorCode::kDegenerateInput);
}

#define SPILLWAY_INSTANTIATE(D) \
  template RunStatistics triangulate_stream<D>(PointStream&, BlockSink&, const RunSetup&);
SPILLWAY_FOR_EACH_DIMENSION(SPILLWAY_INSTANTIATE)
#undef SPILLWAY_INSTANTIATE

}  // namespace spillway::stream
