#include "stream/ranks/rank_executor.h"

#include <spillway/input.h>

#include <utility>

#include "formats/meshes/spool/mesh_spool.h"
#include "src/error.h"
#include "src/geometry/dimensions.h"
#include "src/geometry/simplex_name.h"
#include "src/runtime/packing.h"
#include "stream/library/context/context_state.h"
#include "stream/library/meshes/mesh_file.h"
#include "stream/library/meshes/mesh_passage.h"
#include "stream/library/run.h"
#include "stream/pipeline.h"
#include "stream/ranks/exchange/collective_step.h"
#include "stream/ranks/mesh_output.h"
#include "stream/ranks/periodic_ranks.h"
#include "stream/ranks/rank_pipeline.h"
#include "stream/ranks/resumable_share.h"
#include "stream/ranks/share_messages.h"
#include "stream/ranks/shared_report.h"

namespace spillway::ranks {
namespace {

class RankExecutor final : public Executor {
 public:
  explicit RankExecutor(const distributed::Ranks& ranks) : ranks_(ranks) {}

  [[nodiscard]] bool is_first() const override { return ranks_.rank() == 0; }

  std::unique_ptr<stream::JoinedInputs> open_points(const Context& context,
                                                    const std::vector<std::string>& paths,
                                                    JoinedInputsOptions options) override {
    // The first rank looks for the files.
    return open_shared_source(
        context.state().files(),
        is_first() ? expand_inputs(paths, context) : std::vector<std::string>(), std::move(options),
        ranks_);
  }

  Report triangulate(Run& run) override {
    const RunTrace* const trace = run.engine.asked.trace.get();
    if (trace != nullptr && (trace->takes_nodes() || trace->takes_steps())) {
      throw InvalidArgument("the tasks of a run over ranks are told as sums only");
    }
    stream::JoinedInputs* const source = run.points.files;
    if (source == nullptr) {
      throw InvalidArgument("ranks share points of files, and these are of a program");
    }
    if (run.sink.as_mesh_file() == nullptr && !run.sink.has_shares()) {
      throw InvalidArgument("this sink takes the mesh of one process: triangulate without ranks");
    }
    if (!run.identity) return make_output(run, *source, nullptr);
    ResumableShare share(run, ranks_);
    try {
      return share.complete(make_output(run, *source, &share.checkpoints()));
    } catch (const Failure& error) {
      share.tell_how_to_go_on(error);
      throw;
    }
  }

  Report triangulate_periodically(Run& run) override {
    return ranks::triangulate_periodically(run, ranks_);
  }

 private:
  Report make_output(Run& run, stream::JoinedInputs& source, RankCheckpoints* checkpoints) const {
    const MeshTarget* const target = run.sink.as_mesh_file();
    return target != nullptr ? write_mesh(run, source, *target, checkpoints)
                             : combine_shares(run, source, checkpoints);
  }

  RankMesh triangulate(Run& run, stream::JoinedInputs& source, BlockSink& blocks,
                       RankCheckpoints* checkpoints) const {
    return with_dimension(run.engine.asked.dimension, [&](auto d) {
      return triangulate_over_ranks<d>(source, blocks, run.setup(), ranks_, checkpoints);
    });
  }

  /// The first rank tells what others found in the inputs.
  void tell_notices(const Run& run, const stream::JoinedInputs& source) const {
    Packer own;
    own.put(std::uint64_t{source.untold().size()});
    for (const std::string& notice : source.untold()) own.put_list(notice);
    const auto& warn = run.context.options().warning;
    for (const auto& bytes : ranks_.gather(own.bytes(), 0)) {
      Unpacker of_rank(bytes);
      for (auto left = of_rank.take<std::uint64_t>(); left > 0; --left) {
        const auto notice = of_rank.take_list<std::string>();
        if (warn) warn(notice);
      }
    }
  }

  Report report(const Run& run, const stream::JoinedInputs& source, const RankMesh& mesh) const {
    tell_notices(run, source);
    Report report = shared_report(mesh, source.counts(), ranks_);
    const RunSums sums = shared_sums(mesh, ranks_);
    if (run.engine.asked.trace) run.engine.asked.trace->end(sums);
    report.dimension = run.engine.asked.dimension;
    report.skipped_files = source.skipped();
    report.on_lattice = source.lattice().has_value();
    run_collective_step(ranks_, [&] { refuse_empty_mesh(report, run.engine.asked.max_edge); });
    return report;
  }

  Report write_mesh(Run& run, stream::JoinedInputs& source, const MeshTarget& target,
                    RankCheckpoints* checkpoints) const {
    const auto output = open_mesh_output(disk(), target, run.start().header, *run.scratch, ranks_);
    RankMesh mesh = triangulate(run, source, output->writer(), checkpoints);
    Report report = this->report(run, source, mesh);
    run.watch.begin("write", simplices_of(run.engine.asked.dimension));
    report.output_format = target.format->name;
    report.output_bytes = output->finish(mesh);
    report.write_seconds = run.watch.end(report.mesh.simplices);
    return report;
  }

  Report combine_shares(Run& run, stream::JoinedInputs& source,
                        RankCheckpoints* checkpoints) const {
    EngineSink& sink = run.sink;
    MeshStart start = run.start();
    if (checkpoints != nullptr) start.scratch = run.scratch.get();
    BlockSink& blocks = sink.start(start);
    const bool by_way_of_mesh = checkpoints != nullptr && !sink.goes_on();
    const RankMesh mesh = by_way_of_mesh
                              ? triangulate_by_way_of_mesh(run, source, blocks, *checkpoints)
                              : triangulate(run, source, blocks, checkpoints);
    sink.number_share(mesh.own_section ? mesh.sections[*mesh.own_section].first_vertex : 0);
    for (const MergedSection& merged : mesh.merged) {
      sink.take_merged({.first_vertex = mesh.sections[merged.section].first_vertex,
                        .mesh = merged.mesh,
                        .imported_vertices = merged.imported_vertices});
    }
    Report report = this->report(run, source, mesh);
    if (is_first()) {
      SharesOfOtherRanks others(ranks_);
      sink.finalize(run.watch, report, others);
      others.end();
    } else {
      ShareToFirstRank sender(ranks_);
      sink.give_share(sender);
      sender.end();
    }
    return report;
  }

  /// For a sink that cannot go on in the midst of the blocks: it gets them when all are there.
  RankMesh triangulate_by_way_of_mesh(Run& run, stream::JoinedInputs& source, BlockSink& blocks,
                                      RankCheckpoints& checkpoints) const {
    const MeshStreamHeader header = run.start().header;
    MeshSpool spool(header, run.points.name, *run.scratch);
    RankMesh mesh = triangulate(run, source, spool, &checkpoints);
    finish_own_blocks(spool, mesh);
    const char* const simplices = simplices_of(run.engine.asked.dimension);
    run.watch.begin(simplices, simplices);
    run_collective_step(ranks_, [&] {
      run.watch.end(pass_mesh(*spool.open(), header.attributes, blocks, run.watch,
                              run.sink.feeding_threads(run.context.threads())));
    });
    return mesh;
  }

  const distributed::Ranks& ranks_;
};

}  // namespace

std::shared_ptr<Executor> make_rank_executor(const distributed::Ranks& ranks) {
  return std::make_shared<RankExecutor>(ranks);
}

}  // namespace spillway::ranks
