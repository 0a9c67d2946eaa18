#include <spillway/triangulate.h>

#include <fmt/format.h>

#include <optional>

#include "formats/points/attributes/further_coordinates.h"
#include "src/error.h"
#include "src/geometry/dimensions.h"
#include "stream/library/choice_check.h"
#include "stream/library/context/context_state.h"
#include "stream/library/context/executor.h"
#include "stream/library/crs_notices.h"
#include "stream/library/meshes/program_sink.h"
#include "stream/library/own_parts.h"
#include "stream/library/periodic_run.h"
#include "stream/library/points/program_points.h"
#include "stream/library/points_alone.h"
#include "stream/library/resumable_run.h"
#include "stream/library/run.h"
#include "stream/pipeline.h"
#include "stream/source/joined_inputs.h"

namespace spillway::stream {
namespace {

void check(const TriangulateOptions& options) {
  if (!is_dimension(options.dimension)) {
    throw InvalidArgument(fmt::format("there are 2 to 6 dimensions, not {}", options.dimension));
  }
  if (options.dimension > 3 && options.kernel == Kernel::kCgal) {
    throw InvalidArgument(
        "CGAL's kernel triangulates in 2 and 3 dimensions: choose Spillway's own");
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

void check(const RunPoints& points, int dimension) {
  if (points.dimension != 0 && points.dimension != dimension) {
    throw InvalidArgument(
        fmt::format("{} {} dimensions, not {}",
                    points.files != nullptr ? "the files were opened for" : "the points have",
                    points.dimension, dimension));
  }
  const bool lacks_coordinates = further_axes(dimension) > 0 && points.dimension == 0;
  const std::optional<IntegerLattice>& lattice = points.stream->lattice();
  if (points.files != nullptr &&
      (lacks_coordinates || (lattice && !lattice->isotropic(dimension)))) {
    throw InvalidArgument(fmt::format(
        "the files were not opened to be triangulated: open them for {} dimensions", dimension));
  }
  if (lacks_coordinates) {
    throw InvalidArgument(fmt::format(
        "the points have x, y and z, but are to be triangulated in {} dimensions", dimension));
  }
  // Files without z are told of when they are opened.
  if (points.dimension == 0 && dimension == 3 && !points.has_heights) {
    throw Failure("the points have no z", ErrorCode::kDegenerateInput, {.remedy = Remedy::kPlane});
  }
}

/// All of it in this process.
Report triangulate_here(Run& run) {
  Report report = triangulate_to(run.sink.start(run.start()), run.setup(), run);
  run.sink.complete(run.watch, report);
  return report;
}

}  // namespace

Report triangulate_to(BlockSink& blocks, const RunSetup& setup, Run& run) {
  PointStream& points = *run.points.stream;
  Report report;
  static_cast<RunStatistics&>(report) = with_dimension(run.engine.asked.dimension, [&](auto d) {
    return triangulate_stream<d>(points, blocks, setup);
  });
  if (report.threads < run.engine.threads && run.context.options().detail) {
    run.context.options().detail(
        fmt::format("{} of {} threads used: more of them need a larger memory limit",
                    report.threads, run.engine.threads));
  }
  report.dimension = run.engine.asked.dimension;
  report.points = points.counts();
  if (run.points.files != nullptr) report.skipped_files = run.points.files->skipped();
  report.on_lattice = points.lattice().has_value();
  refuse_empty_mesh(report, run.engine.asked.max_edge);
  return report;
}

MeshStart Run::start() const {
  MeshStart start;
  start.header.dimension = engine.asked.dimension;
  start.header.has_input_index = engine.asked.input_index;
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

}  // namespace spillway::stream

namespace spillway {

Report triangulate(PointSource& source, MeshSink& sink, const TriangulateOptions& options,
                   const Context& context) {
  using namespace stream;  // NOLINT(google-build-using-namespace): the other side of the door
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
  const bool index = options.input_index || executor != nullptr || options.periodic;
  Run run{.context = context,
          .watch = watch,
          .points = points->begin(watch, index),
          .sink = *target,
          .engine = {.asked = options, .threads = context.threads()},
          .budget = MemoryBudget(context.memory() - own, context.memory()),
          .scratch = context.state().scratch(context)};
  run.engine.record_size = run.points.attributes.record_size();
  check(run.points, options.dimension);
  if (options.periodic) check_periodic(options, *target);
  // Rasters and the like have their own ways with units.
  if (!target->is_product()) tell_units(run.points.crs, run.points.extent, context);
  target->check_attributes(run.points.offered);
  // Processes share points out as they triangulate them.
  if (!target->wants_simplices() && executor == nullptr && !options.periodic) {
    if (!options.resume_folder.empty()) {
      throw InvalidArgument(
          "a run of products of points alone triangulates nothing, and cannot go "
          "on: leave the folder to resume out");
    }
    return take_points_alone(run);
  }
  if (!options.resume_folder.empty()) run.identity = identity_of(run, *points);
  Report report;
  if (options.periodic) {
    report = executor != nullptr ? executor->triangulate_periodically(run)
                                 : triangulate_periodically(run);
  } else if (executor != nullptr) {
    report = executor->triangulate(run);
  } else {
    report = run.identity ? triangulate_resumably(run) : triangulate_here(run);
  }
  report.lost = target->lost_attributes(run.points.offered, true);
  return report;
}

}  // namespace spillway
