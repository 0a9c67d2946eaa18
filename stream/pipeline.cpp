#include "stream/pipeline.h"

#include <fmt/format.h>

#include "src/delaunay/base_case.h"
#include "src/error.h"
#include "src/parallel/parallel.h"
#include "stream/triangulate/tile_engine.h"

namespace spillway::detail {
namespace {

/// Points of a source as a tree of tiles takes them.
PointFeed feed_of(PointStream& source, const StreamOptions& options, StageTimes& times) {
  return {.fetch =
              [&](SourcePiece& piece) {
                const StageTimer timer(times, Stage::kRead);
                options.progress(source.points_read(), source.fraction_read());
                return source.fetch(piece);
              },
          .decode =
              [&](SourcePiece& piece, PointBlock& block) {
                const StageTimer timer(times, Stage::kRead);
                source.decode(piece, block);
              }};
}

template <int D>
void run(TileEngine<D>& engine, PointStream& source, MemoryBudget& budget,
         const StreamOptions& options) {
  options.begin_phase("read");
  engine.spill(feed_of(source, options, engine.times()));
  options.end_phase(source.points_read());
  if (engine.points_to_divide() > 0) {
    options.begin_phase("divide");
    options.end_phase(engine.divide_large());
  }
  options.begin_phase("triangulate");
  const std::optional<TileNode<D>> root = engine.nodes();
  if (!root) refuse_empty_input(source.counts());
  refuse_flat_points(engine.span(), engine.points());
  options.extent_known(plane_of(root->box), root->points);
  budget.set_enough(enough_memory<D>(root->points));
  engine.triangulate(*root, {});
  options.end_phase(engine.points());
}

}  // namespace

template <int D>
RunFigures triangulate_stream(PointStream& source, BlockSink& sink, ScratchFolder& scratch,
                              MemoryBudget& budget, const StreamOptions& options) {
  TileEngine<D> engine({source.lattice(), source.expected(), source.extent()}, sink, scratch,
                       budget, options);
  with_threads(engine.threads(), [&] { run(engine, source, budget, options); });
  release_base_case_memory();
  return engine.figures();
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
