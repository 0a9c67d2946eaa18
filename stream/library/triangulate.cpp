#include <spillway/triangulate.h>

#include <fmt/format.h>

#include <optional>

#include "src/error.h"
#include "stream/library/choice_check.h"
#include "stream/library/context/context_state.h"
#include "stream/library/context/executor.h"
#include "stream/library/meshes/program_sink.h"
#include "stream/library/own_parts.h"
#include "stream/library/points/program_points.h"
#include "stream/library/resumable_run.h"
#include "stream/library/run.h"
#include "stream/pipeline.h"
#include "stream/plan/run_trace.h"
#include "stream/source/point_source.h"

namespace spillway::detail {
namespace {

void check(const TriangulateOptions& options) {
  if (options.dimension != 2 && options.dimension != 3) {
    throw InvalidArgument(fmt::format("there are 2 or 3 dimensions, not {}", options.dimension));
  }
  check_choice(options.heights, Heights::kMean, "choice of heights");
  check_choice(options.division, Division::kConstantAxis, "division");
  check_choice(options.kernel, Kernel::kCgal, "kernel");
  check_max_edge(options.max_edge);
  if (!(options.checkpoint_seconds >= 0)) {
    throw InvalidArgument(
        fmt::format("checkpoints are not {} seconds apart", options.checkpoint_seconds));
  }
  if (options.children < 2 || options.children > 1024) {
    throw InvalidArgument(
        fmt::format("2 to 1024 parts are merged at a time, not {}", options.children));
  }
}

StreamOptions stream_options(const TriangulateOptions& options, const Context& context,
                             EngineSink& sink, RunWatch& watch) {
  StreamOptions stream;
  stream.threads = context.threads();
  stream.tile_capacity = options.tile_points;
  stream.leaf_size = options.leaf_points;
  stream.division = options.division;
  stream.children = options.children;
  stream.kernel = options.kernel;
  stream.heights = options.heights;
  stream.max_edge = options.max_edge;
  stream.input_index = options.input_index;
  stream.trace = options.trace.get();
  stream.early = options.trust_headers;
  stream.needs_extent = sink.wants_extent() && options.dimension == 2;
  stream.extent_told = [&sink](const Box<2>& extent, std::uint64_t points) {
    return sink.extent_told(extent, points);
  };
  stream.extent_holds = [&sink](const Box<2>& extent) { return sink.extent_holds(extent); };
  stream.begin_again = [&sink, &options] {
    BlockSink* const blocks = sink.begin_again();
    if (blocks != nullptr && options.trace) options.trace->begin_again();
    return blocks;
  };
  if (context.options().warning) stream.warn = context.options().warning;
  stream.extent_known = [&sink](const Box<2>& extent, std::uint64_t points) {
    sink.extent_known(extent, points);
  };
  stream.begin_phase = [&watch](const char* phase) { watch.begin(phase, "points"); };
  stream.end_phase = [&watch](std::uint64_t points) { watch.end(points); };
  stream.progress = [&watch](std::uint64_t points, std::optional<double> fraction) {
    watch.tell(points, fraction);
  };
  return stream;
}

void check(const RunPoints& points, int dimension) {
  if (points.dimension != 0 && points.dimension != dimension) {
    throw InvalidArgument(fmt::format("the files were opened for {} dimensions, not for {}",
                                      points.dimension, dimension));
  }
  const std::optional<Lattice>& lattice = points.stream->lattice();
  if (points.files != nullptr && lattice && !lattice->isotropic(dimension)) {
    throw InvalidArgument(fmt::format(
        "the files were not opened to be triangulated: open them for {} dimensions", dimension));
  }
  // Files without z are told of when they are opened.
  if (points.dimension == 0 && dimension == 3 && !points.has_heights) {
    throw Error("the points have no z", ErrorCode::kDegenerateInput, {.remedy = Remedy::kPlane});
  }
}

/// All of it in this process.
Report triangulate_here(Run& run) {
  Report report = triangulate_to(run.sink.start(run.start()), *run.scratch, run);
  run.sink.complete(run.watch, report);
  return report;
}

}  // namespace

Report triangulate_to(BlockSink& blocks, ScratchFolder& scratch, Run& run) {
  PointStream& points = *run.points.stream;
  Report report;
  static_cast<RunFigures&>(report) =
      run.options.dimension == 2
          ? triangulate_stream<2>(points, blocks, scratch, run.budget, run.stream)
          : triangulate_stream<3>(points, blocks, scratch, run.budget, run.stream);
  if (report.threads < run.stream.threads && run.context.options().detail) {
    run.context.options().detail(
        fmt::format("{} of {} threads used: more of them need a larger memory limit",
                    report.threads, run.stream.threads));
  }
  report.dimension = run.options.dimension;
  report.points = points.counts();
  if (run.points.files != nullptr) report.skipped_files = run.points.files->skipped();
  report.on_lattice = points.lattice().has_value();
  refuse_empty_mesh(report, run.options.max_edge);
  return report;
}

MeshStart Run::start() const {
  MeshStart start;
  start.header.dimension = options.dimension;
  start.header.has_input_index = options.input_index;
  start.header.lattice = points.stream->lattice();
  start.header.points = points.records;
  start.header.crs = points.crs;
  start.header.extent = points.extent;
  start.header.attributes = points.attributes;
  start.is_triangulated = true;
  start.has_heights = points.has_heights;
  start.name = points.name;
  return start;
}

}  // namespace spillway::detail

namespace spillway {

Report triangulate(PointSource& source, MeshSink& sink, const TriangulateOptions& options,
                   const Context& context) {
  using namespace detail;  // NOLINT(google-build-using-namespace): the other side of the door
  check(options);
  RunWatch watch(context);
  watch.check();
  std::optional<ProgramPoints> program_points;
  auto* points = OwnParts::of(source);
  if (points == nullptr) points = &program_points.emplace(source, options.dimension);
  std::optional<ProgramSink> program_sink;
  auto* target = OwnParts::of(sink);
  if (target == nullptr) target = &program_sink.emplace(sink);
  points->settle_crs(target->crs_need());
  points->carry(target->wanted_attributes(true));
  const std::uint64_t own = target->own_memory(context.memory());
  Executor* const executor = context.options().executor.get();
  // Processes tell by the index which of several equal points comes first.
  const bool index = options.input_index || executor != nullptr;
  Run run{.context = context,
          .options = options,
          .watch = watch,
          .points = points->begin(watch, index),
          .sink = *target,
          .stream = stream_options(options, context, *target, watch),
          .budget = MemoryBudget(context.memory() - own, context.memory()),
          .scratch = context.state().scratch(context)};
  run.stream.record_size = run.points.attributes.record_size();
  check(run.points, options.dimension);
  target->check_attributes(run.points.offered);
  if (!options.resume_folder.empty()) run.identity = identity_of(run, *points);
  Report report;
  if (executor != nullptr) {
    report = executor->triangulate(run);
  } else {
    report = run.identity ? triangulate_resumably(run) : triangulate_here(run);
  }
  report.lost = target->lost_attributes(run.points.offered, true);
  return report;
}

}  // namespace spillway
