#include "stream/ranks/rank_executor.h"

#include <spillway/input.h>

#include <utility>

#include "src/error.h"
#include "src/geometry/simplex_name.h"
#include "src/parallel/parallel.h"
#include "stream/library/context/context_state.h"
#include "stream/library/meshes/mesh_file.h"
#include "stream/library/products/dem_file.h"
#include "stream/library/run.h"
#include "stream/pipeline.h"
#include "stream/ranks/exchange/collective_step.h"
#include "stream/ranks/mesh_output.h"
#include "stream/ranks/rank_pipeline.h"
#include "stream/ranks/raster_merge.h"
#include "stream/ranks/shared_report.h"

namespace spillway::detail {
namespace {

class RankExecutor final : public Executor {
 public:
  explicit RankExecutor(const distributed::Ranks& ranks) : ranks_(ranks) {}

  [[nodiscard]] bool is_first() const override { return ranks_.rank() == 0; }

  std::unique_ptr<detail::PointSource> open_points(const Context& context,
                                                   const std::vector<std::string>& paths,
                                                   PointSourceOptions options) override {
    // The first rank looks for the files.
    return open_shared_source(
        context.state().files(),
        is_first() ? spillway::expand_inputs(paths, context) : std::vector<std::string>(),
        std::move(options), ranks_);
  }

  Report triangulate(Run& run) override {
    if (run.options.task_done || run.options.step_done) {
      throw InvalidArgument("the tasks of a run over ranks are told as sums only");
    }
    auto* const source = dynamic_cast<detail::PointSource*>(run.points.stream);
    if (source == nullptr) {
      throw InvalidArgument("ranks share points of files, and these are of a program");
    }
    if (auto* const mesh = dynamic_cast<MeshFile*>(&run.sink))
      return write_mesh(run, *source, *mesh);
    if (auto* const dem = dynamic_cast<DemFile*>(&run.sink)) return write_dem(run, *source, *dem);
    throw InvalidArgument("ranks share the making of mesh files and DEMs, and this is neither");
  }

 private:
  RankMesh triangulate(Run& run, detail::PointSource& source, BlockSink& blocks) const {
    return run.options.dimension == 2 ? triangulate_over_ranks<2>(source, blocks, *run.scratch,
                                                                  run.budget, run.stream, ranks_)
                                      : triangulate_over_ranks<3>(source, blocks, *run.scratch,
                                                                  run.budget, run.stream, ranks_);
  }

  Report report(const Run& run, const detail::PointSource& source, const RankMesh& mesh) const {
    Report report = shared_report(mesh, source.counts(), ranks_);
    report.dimension = run.options.dimension;
    report.on_lattice = source.lattice().has_value();
    run_collective_step(ranks_, [&] { refuse_empty_mesh(report, run.options.max_edge); });
    return report;
  }

  Report write_mesh(Run& run, detail::PointSource& source, const MeshFile& file) const {
    const auto output =
        open_mesh_output(disk(), file.target(), run.start().header, *run.scratch, ranks_);
    RankMesh mesh = triangulate(run, source, output->writer());
    Report report = this->report(run, source, mesh);
    run.watch.begin("write", simplices_of(run.options.dimension));
    report.output_format = file.target().format->name;
    report.output_bytes = output->finish(mesh);
    report.write_seconds = run.watch.end(report.mesh.simplices);
    return report;
  }

  Report write_dem(Run& run, detail::PointSource& source, DemFile& file) const {
    BlockSink& blocks = file.start(run.start());
    const RankMesh mesh = triangulate(run, source, blocks);
    for (const MergedSection& section : mesh.merged) paint_merged(file.dem(), section);
    Report report = this->report(run, source, mesh);
    if (is_first()) {
      file.complete(run.watch, report, [&](Raster& raster, const auto& written) {
        write_raster_of_ranks(file.dem(), raster, written, ranks_);
      });
    } else {
      with_threads(file.feeding_threads(run.context.threads()),
                   [&] { send_raster(file.dem(), ranks_); });
    }
    return report;
  }

  const distributed::Ranks& ranks_;
};

}  // namespace

std::shared_ptr<Executor> make_rank_executor(const distributed::Ranks& ranks) {
  return std::make_shared<RankExecutor>(ranks);
}

}  // namespace spillway::detail
