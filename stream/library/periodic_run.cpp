#include "stream/library/periodic_run.h"

#include <fmt/format.h>

#include <limits>
#include <mutex>
#include <optional>
#include <utility>
#include <vector>

#include "formats/meshes/spool/mesh_spool.h"
#include "src/error.h"
#include "src/geometry/margin_survey.h"
#include "src/parallel/parallel.h"
#include "stream/ground/repeated_points.h"
#include "stream/periodic/periodic_blocks.h"
#include "stream/periodic/periodic_points.h"
#include "stream/source/joined_inputs.h"

namespace spillway::stream {
namespace {

constexpr double kWidest = std::numeric_limits<double>::infinity();

/// Pieces under way at a time, for each thread and one more.
constexpr std::size_t kPiecesPerThread = 2;

bool can_read_again(const RunPoints& points) {
  return points.files != nullptr && points.files->any_order() && !points.files->thins();
}

class PeriodicRun {
 public:
  explicit PeriodicRun(Run& run)
      : run_(run),
        torus_(torus_of(run.points, run.engine.asked)),
        has_input_index_(std::exchange(run.engine.asked.input_index, true)),
        repeated_(*run.points.stream, can_read_again(run.points), *run.scratch,
                  RepeatedIndex::kInput),
        copies_(torus_),
        points_(repeated_, copies_) {
    run.points.stream = &points_;
    run.points.extent.reset();
  }

  Report run() {
    const MeshStart start = periodic_start(run_, torus_, has_input_index_);
    const bool direct = run_.sink.can_begin_again();
    BlockSink* sink = &run_.sink.start(start);
    double margin = survey();
    for (bool first = true;; first = false) {
      domain_.emplace(torus_, margin);
      copies_.begin(*domain_);
      repeated_.repeat();
      run_.engine.periodic = domain_;
      if (!first && direct) sink = run_.sink.begin_again();
      std::optional<Report> report = direct ? to_sink(*sink) : by_spool(*sink);
      if (report) {
        run_.sink.complete(run_.watch, *report);
        return std::move(*report);
      }
      margin = wider_margin(margin, torus_);
    }
  }

 private:
  /// Reads all points, and returns a margin for copies of them.
  double survey() {
    struct Slot {
      SourcePiece piece;
      PointBlock block;
    };
    MarginSurvey survey(torus_);
    std::uint64_t count = 0;
    const unsigned threads = run_.context.threads();
    std::vector<Slot> slots(kPiecesPerThread * threads + 1);
    const auto fetch = [&](std::size_t slot) {
      run_.watch.tell(points_.points_read(), points_.fraction_read());
      return points_.fetch(slots[slot].piece);
    };
    const auto decode = [&](std::size_t slot) {
      points_.decode(slots[slot].piece, slots[slot].block);
    };
    const auto take = [&](std::size_t slot) {
      if (torus_.closed()) {
        survey.add(std::span<const LatticePoint>(slots[slot].block.points));
      }
      count += slots[slot].block.size();
    };
    const std::vector<PipelineStep> steps = {{.in_order = false, .work = decode},
                                             {.in_order = true, .work = take}};
    run_.watch.begin("survey", "points");
    with_threads(threads, [&] { run_pipeline(slots.size(), fetch, steps); });
    run_.watch.end(count);
    if (count == 0) refuse_empty_input(points_.counts());
    return torus_.closed() ? survey.margin() : kWidest;
  }

  std::optional<Report> to_sink(BlockSink& sink) {
    PeriodicBlocks blocks(sink, *domain_, has_input_index_, run_.budget);
    std::optional<Report> report = triangulate(blocks);
    if (report) end_blocks(blocks, *report);
    return report;
  }

  /// For a sink that cannot take back what it got.
  std::optional<Report> by_spool(BlockSink& sink) {
    MeshStreamHeader header = run_.start().header;
    MeshSpool spool(header, "the periodic mesh", *run_.scratch);
    std::optional<Report> report = triangulate(spool);
    if (!report) return report;
    spool.finish(report->mesh);
    PeriodicBlocks blocks(sink, *domain_, has_input_index_, run_.budget);
    const auto reader = spool.open();
    MeshStreamBlock block;
    while (reader->read(block)) {
      run_.watch.check();
      blocks.absorb(block);
      blocks.write(std::move(block));
      block = {};
    }
    end_blocks(blocks, *report);
    return report;
  }

  /// Nothing if the margin was too narrow.
  std::optional<Report> triangulate(BlockSink& blocks) {
    TorusProof proof;
    RunSetup setup = run_.setup();
    setup.torus = &proof;
    Report report;
    try {
      report = triangulate_to(blocks, setup, run_);
    } catch (const Failure& error) {
      if (error.code() != ErrorCode::kDegenerateInput) throw;
      refuse_flat_copies(*domain_);
      return std::nullopt;
    }
    if (!is_proved(proof, *domain_, run_.context)) return std::nullopt;
    return report;
  }

  Run& run_;
  const Torus torus_;
  const bool has_input_index_;
  RepeatedPoints repeated_;
  PeriodicCopies copies_;
  PeriodicPoints points_;
  std::optional<PeriodicDomain> domain_;
};

void tell_margin(const PeriodicDomain& domain, const char* what, const Context& context) {
  if (!context.options().detail) return;
  const Torus& torus = domain.torus();
  double widest = 0;
  for (int k = 0; k < torus.dimension(); ++k) {
    if (torus.periodic(k)) widest = std::max(widest, domain.margin(k) / torus.period(k));
  }
  context.options().detail(
      fmt::format("a margin of {:.3g} periods for copies of points {}", widest, what));
}

}  // namespace

Torus torus_of(const RunPoints& points, const TriangulateOptions& options) {
  const std::optional<IntegerLattice>& lattice = points.stream->lattice();
  return lattice ? Torus(*options.periodic, options.dimension, *lattice)
                 : Torus(*options.periodic, options.dimension);
}

MeshStart periodic_start(const Run& run, const Torus& torus, bool has_input_index) {
  MeshStart start = run.start();
  start.header.has_input_index = has_input_index;
  start.header.periodic =
      run.points.stream->lattice() ? run.engine.asked.periodic : std::optional(torus.box());
  start.header.extent.reset();
  return start;
}

void refuse_flat_copies(const PeriodicDomain& domain) {
  if (!domain.widest()) return;
  throw Failure(domain.torus().dimension() == 2
                    ? "the points, with all of their copies, lie on one line"
                    : "the points, with all of their copies, lie on one line or in one plane",
                ErrorCode::kDegenerateInput);
}

bool is_proved(const TorusProof& proof, const PeriodicDomain& domain, const Context& context) {
  const Torus& torus = domain.torus();
  const bool holds = proof.holds();
  if (torus.closed() && (holds || domain.widest())) refuse_long_simplices(torus, proof.reach);
  if (holds) {
    tell_margin(domain, "was enough", context);
    return true;
  }
  if (domain.widest()) {
    throw std::logic_error("a periodic mesh is not closed: a fault of the program");
  }
  tell_margin(domain, "is too narrow: once more with a wider one", context);
  return false;
}

void end_blocks(PeriodicBlocks& blocks, Report& report) {
  blocks.finish(report.mesh);
  report.mesh.vertices = blocks.vertices();
  report.mesh.points = report.points.kept();
  report.mesh.duplicates = report.mesh.points - report.mesh.vertices;
}

void check_periodic(const TriangulateOptions& options, const EngineSink& sink) {
  if (options.dimension > 3) {
    throw InvalidArgument(
        fmt::format("periodic boxes have 2 or 3 dimensions, not {}", options.dimension));
  }
  if (options.max_edge) {
    throw InvalidArgument(
        "a periodic triangulation has no long edges to leave out: choose either a periodic box or "
        "a longest edge");
  }
  if (!options.resume_folder.empty()) {
    throw InvalidArgument("a periodic run cannot go on: leave the folder to resume out");
  }
  sink.check_periodic(options.dimension);
}

Report triangulate_periodically(Run& run) { return PeriodicRun(run).run(); }

}  // namespace spillway::stream
