#include "stream/library/points_alone.h"

#include <cstddef>
#include <optional>
#include <vector>

#include "src/error.h"
#include "src/parallel/parallel.h"
#include "stream/ground/repeated_points.h"
#include "stream/points/seen_extent.h"
#include "stream/source/joined_inputs.h"

namespace spillway::stream {
namespace {

/// Pieces under way at a time, for each thread and one more.
constexpr std::size_t kPiecesPerThread = 2;

class PointsAlone {
 public:
  explicit PointsAlone(Run& run)
      : run_(run),
        threads_(run.sink.feeding_threads(run.context.threads())),
        points_(*run.points.stream, can_read_again(run.points), *run.scratch) {}

  Report take() {
    run_.sink.start(run_.start());
    const bool needs_extent = run_.sink.wants_extent();
    const std::optional<Box<2>> told = needs_extent ? told_extent() : std::nullopt;
    pass("read", !needs_extent || told);
    if (count_ == 0) refuse_empty_input(points_.counts());
    if (needs_extent && !(told && (*told == seen_.box() || run_.sink.extent_holds(seen_.box())))) {
      if (told) {
        run_.watch.warn(
            "headers tell another extent than that of the points: all points are read again");
        run_.sink.begin_again();
      }
      run_.sink.extent_known(seen_.box(), count_);
      points_.repeat();
      pass("deal", true);
    }
    return report();
  }

 private:
  static bool can_read_again(const RunPoints& points) {
    return points.files != nullptr && points.files->any_order() && !points.files->thins();
  }

  /// That of headers, if the sink can begin with it.
  [[nodiscard]] std::optional<Box<2>> told_extent() const {
    if (!run_.engine.asked.trust_headers) return std::nullopt;
    const PointStream& stream = *run_.points.stream;
    const std::optional<Box<2>> told = stream.told_extent();
    if (!told || !run_.sink.extent_told(*told, stream.expected().value_or(0))) return std::nullopt;
    return told;
  }

  /// Sees all points, and gives them to the sink if `give`.
  void pass(const char* phase, bool give) {
    struct Slot {
      SourcePiece piece;
      PointBlock block;
    };
    std::vector<Slot> slots(kPiecesPerThread * threads_ + 1);
    const auto fetch = [&](std::size_t slot) {
      run_.watch.tell(points_.points_read(), points_.fraction_read());
      return points_.fetch(slots[slot].piece);
    };
    const auto take = [&](std::size_t slot) {
      auto& [piece, block] = slots[slot];
      points_.decode(piece, block);
      seen_.add(PointsView::of(block));
      if (give) run_.sink.take_points(block.points);
    };
    const auto count = [&](std::size_t slot) { count_ += slots[slot].block.size(); };
    const std::vector<PipelineStep> steps = {{.in_order = false, .work = take},
                                             {.in_order = true, .work = count}};
    run_.watch.begin(phase, "points");
    count_ = 0;
    with_threads(threads_, [&] { run_pipeline(slots.size(), fetch, steps); });
    seconds_ += run_.watch.end(points_.points_read());
  }

  Report report() {
    Report report;
    report.dimension = run_.engine.asked.dimension;
    report.threads = threads_;
    report.mesh.points = count_;
    report.read_seconds = seconds_;
    report.points = points_.counts();
    report.on_lattice = points_.lattice().has_value();
    if (run_.points.files != nullptr) report.skipped_files = run_.points.files->skipped();
    run_.sink.complete(run_.watch, report);
    return report;
  }

  Run& run_;
  const unsigned threads_;
  RepeatedPoints points_;
  SeenExtent<2> seen_;
  std::uint64_t count_ = 0;
  double seconds_ = 0;
};

}  // namespace

Report take_points_alone(Run& run) { return PointsAlone(run).take(); }

}  // namespace spillway::stream
