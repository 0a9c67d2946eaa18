#include "stream/ranks/periodic_ranks.h"

#include <limits>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "src/error.h"
#include "src/geometry/dimensions.h"
#include "src/geometry/margin_survey.h"
#include "src/geometry/simplex_name.h"
#include "stream/library/periodic_run.h"
#include "stream/periodic/periodic_copies.h"
#include "stream/ranks/exchange/collective_step.h"
#include "stream/ranks/mesh_output.h"
#include "stream/ranks/rank_pipeline.h"
#include "stream/ranks/shared_report.h"
#include "stream/source/joined_inputs.h"

namespace spillway::ranks {
namespace {

using distributed::Ranks;
using distributed::Reduction;

/// Takes the blocks of all ranks at the first one.
class PeriodicWriter final : public MeshStreamWriter {
 public:
  explicit PeriodicWriter(PeriodicBlocks& blocks) : blocks_(blocks) {}

  void write(MeshStreamBlock&& block) override { blocks_.write(std::move(block)); }
  void finish(const MeshTotals& /*totals*/) override {}
  [[nodiscard]] std::uint64_t bytes_written() const override { return 0; }

 private:
  PeriodicBlocks& blocks_;
};

class PeriodicRanks {
 public:
  PeriodicRanks(Run& run, const Ranks& ranks)
      : run_(run),
        ranks_(ranks),
        source_(shared_points(run)),
        torus_(torus_of(run.points, run.engine.asked)),
        has_input_index_(std::exchange(run.engine.asked.input_index, true)),
        copies_(torus_) {}

  Report run() {
    BlockSink* sink = nullptr;
    run_collective_step(ranks_, [&] {
      if (is_first()) sink = &run_.sink.start(periodic_start(run_, torus_, has_input_index_));
    });
    const std::uint64_t points = source_.expected().value_or(0);
    double margin = torus_.closed() ? margin_of_even_points(torus_, points)
                                    : std::numeric_limits<double>::infinity();
    source_.repeat_in(copies_);
    for (;; margin = wider_margin(margin, torus_)) {
      domain_.emplace(torus_, margin);
      copies_.begin(*domain_);
      run_.engine.periodic = domain_;
      if (std::optional<Report> report = triangulate(sink)) return std::move(*report);
      source_.read_again(false);
    }
  }

 private:
  [[nodiscard]] bool is_first() const { return ranks_.rank() == 0; }

  static JoinedInputs& shared_points(const Run& run) {
    JoinedInputs* const source = run.points.files;
    if (source == nullptr) {
      throw InvalidArgument("ranks share points of files, and these are of a program");
    }
    if (!source->any_order() || source->thins() || !source->numbers_pieces()) {
      throw InvalidArgument(
          "over ranks points of a periodic triangulation come from files that tell how many there "
          "are, without thinning: convert them, or start one process");
    }
    return *source;
  }

  /// Nothing if the margin was too narrow.
  std::optional<Report> triangulate(BlockSink* sink) {
    std::optional<PeriodicBlocks> blocks;
    std::unique_ptr<MeshStreamWriter> writer;
    if (sink != nullptr) {
      blocks.emplace(*sink, *domain_, has_input_index_, run_.budget);
      writer = std::make_unique<PeriodicWriter>(*blocks);
    }
    const auto output = collect_mesh("the periodic mesh", run_.start().header, *run_.scratch,
                                     ranks_, std::move(writer));
    TorusProof own;
    RunSetup setup = run_.setup();
    setup.torus = &own;
    RankMesh mesh = with_dimension(run_.engine.asked.dimension, [&](auto d) {
      return triangulate_over_ranks<d>(source_, output->writer(), setup, ranks_);
    });
    const TorusProof proof = of_all(own);
    bool proved = false;
    run_collective_step(ranks_, [&] { proved = is_proved(proof, *domain_, run_.context); });
    if (!proved) return std::nullopt;
    Report report = shared_report(mesh, source_.counts(), ranks_);
    report.dimension = run_.engine.asked.dimension;
    report.skipped_files = source_.skipped();
    report.on_lattice = source_.lattice().has_value();
    output->finish(mesh);
    run_collective_step(ranks_, [&] {
      if (!blocks) return;
      end_blocks(*blocks, report);
      run_.sink.complete(run_.watch, report);
    });
    return report;
  }

  /// Sums over all ranks, and the longest reach.
  [[nodiscard]] TorusProof of_all(const TorusProof& own) const {
    std::vector<std::uint64_t> sums = {own.open_facets, own.beyond_margin};
    ranks_.reduce(sums, Reduction::kSum);
    TorusProof all{.open_facets = sums[0], .beyond_margin = sums[1], .reach = own.reach};
    ranks_.reduce(all.reach, Reduction::kMost);
    return all;
  }

  Run& run_;
  const Ranks& ranks_;
  JoinedInputs& source_;
  const Torus torus_;
  const bool has_input_index_;
  PeriodicCopies copies_;
  std::optional<PeriodicDomain> domain_;
};

}  // namespace

Report triangulate_periodically(Run& run, const Ranks& ranks) {
  return PeriodicRanks(run, ranks).run();
}

}  // namespace spillway::ranks
