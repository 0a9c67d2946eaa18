#include "stream/library/convert_points.h"

#include <functional>
#include <optional>
#include <utility>
#include <vector>

#include "src/error.h"
#include "src/parallel/parallel.h"
#include "stream/library/context/run_watch.h"
#include "stream/library/own_parts.h"
#include "stream/library/points/attribute_records.h"
#include "stream/library/points/engine_points.h"
#include "stream/library/points/point_file.h"
#include "stream/library/points/program_points.h"
#include "stream/library/points/public_points.h"
#include "stream/library/sort_points.h"
#include "stream/source/joined_inputs.h"

namespace spillway::stream {
namespace {

/// Pieces of the inputs under way at a time.
constexpr std::size_t kSlots = 6;

/// Gives all points to `write`, in order, decoding on all threads.
void read_all(PointStream& points, unsigned threads, RunWatch& watch,
              const std::function<void(PointBlock&)>& write) {
  struct Slot {
    SourcePiece piece;
    PointBlock block;
  };
  std::vector<Slot> slots(kSlots);
  const std::vector<PipelineStep> steps = {
      {.in_order = false,
       .work = [&](std::size_t slot) { points.decode(slots[slot].piece, slots[slot].block); }},
      {.in_order = true, .work = [&](std::size_t slot) { write(slots[slot].block); }}};
  const auto fetch = [&](std::size_t slot) {
    watch.tell(points.points_read(), points.fraction_read());
    return points.fetch(slots[slot].piece);
  };
  with_threads(threads, [&] { run_pipeline(kSlots, fetch, steps); });
}

PointConversion to_file(const RunPoints& points, PointFile& file, unsigned threads,
                        RunWatch& watch) {
  file.start(points, {.at_once = threads, .run = share_out});
  read_all(*points.stream, threads, watch, [&](PointBlock& block) { file.append(block); });
  bool finishes = false;
  const auto finishing = [&](std::uint64_t done) {
    const std::uint64_t all = points.stream->points_read();
    if (!std::exchange(finishes, true)) {
      watch.end(all);
      watch.begin("write", "points");
    }
    watch.tell(done, static_cast<double>(done) / static_cast<double>(all));
  };
  PointConversion done;
  with_threads(threads, [&] { done = file.complete(finishing); });
  return done;
}

PointConversion to_program(const RunPoints& points, spillway::PointSink& sink, unsigned threads,
                           RunWatch& watch) {
  PointsHeader header;
  header.coordinates = points.has_heights ? 3 : 2;
  header.count = points.stream->expected();
  if (points.extent) header.extent = Extent{points.extent->lo, points.extent->hi};
  header.crs = points.crs;
  const std::optional<IntegerLattice>& lattice = points.stream->lattice();
  header.lattice = public_lattice(lattice, points.heights_on_lattice);
  header.attributes = points.attributes.attributes();
  sink.begin(header);
  PointConversion done;
  read_all(*points.stream, threads, watch, [&](PointBlock& block) {
    if (block.size() == 0) return;
    sink.write(public_points(lattice, block.points),
               columns_of(points.attributes, block.attributes));
    done.written += block.size();
  });
  sink.finish();
  return done;
}

}  // namespace

AttributeChoice prepare_for(spillway::PointSink& sink, EnginePoints& points) {
  const auto* const file = OwnParts::of(sink);
  if (file != nullptr) points.settle_crs(file->crs_need());
  AttributeChoice choice =
      file != nullptr ? file->wanted_attributes() : attribute_choice(sink.attributes_wanted());
  points.carry(choice);
  return choice;
}

PointConversion pass_on(const RunPoints& points, const char* phase, spillway::PointSink& sink,
                        const Context& context, RunWatch& watch) {
  auto* const file = OwnParts::of(sink);
  if (file != nullptr && file->sorted()) return sort_points(points, *file, context, watch);
  watch.begin(phase, "points");
  PointConversion done = file != nullptr ? to_file(points, *file, context.threads(), watch)
                                         : to_program(points, sink, context.threads(), watch);
  watch.end(points.stream->points_read());
  done.points = points.stream->counts();
  if (points.files != nullptr) done.skipped_files = points.files->skipped();
  return done;
}

}  // namespace spillway::stream

namespace spillway {

PointConversion convert(PointSource& source, PointSink& sink, const Context& context) {
  using namespace stream;  // NOLINT(google-build-using-namespace): the other side of the door
  RunWatch watch(context);
  watch.check();
  std::optional<ProgramPoints> program_points;
  auto* points = OwnParts::of(source);
  if (points == nullptr) points = &program_points.emplace(source, 0);
  prepare_for(sink, *points);
  return pass_on(points->begin(watch, true), points->phase(), sink, context, watch);
}

}  // namespace spillway
