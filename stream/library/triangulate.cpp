#include <spillway/triangulate.h>

#include <fmt/format.h>

#include <cmath>
#include <memory>
#include <optional>
#include <utility>

#include "formats/disk/scratch_folder.h"
#include "src/error.h"
#include "src/runtime/memory_budget.h"
#include "stream/library/file_mesh.h"
#include "stream/library/file_points.h"
#include "stream/library/program_points.h"
#include "stream/library/public_values.h"
#include "stream/library/run_watch.h"
#include "stream/pipeline.h"

namespace spillway::detail {
namespace {

/// A program's sink, as the engine writes to it.
class SinkBlocks final : public BlockSink {
 public:
  /// `sink` must outlive it.
  SinkBlocks(spillway::MeshSink& sink, MeshStreamHeader header)
      : sink_(sink), header_(std::move(header)) {
    sink_.begin(public_header(header_));
  }

  void write(MeshBlock&& block) override {
    const std::uint64_t first = vertices_;
    vertices_ += block.vertices.size();
    sink_.write(public_block(header_, std::move(block), first));
  }
  void finish(const MeshTotals& totals) override { sink_.finish(public_totals(totals)); }

 private:
  spillway::MeshSink& sink_;
  MeshStreamHeader header_;
  std::uint64_t vertices_ = 0;
};

void check(const TriangulateOptions& options) {
  if (options.dimension != 2 && options.dimension != 3) {
    throw InvalidArgument(fmt::format("there are 2 or 3 dimensions, not {}", options.dimension));
  }
  if (options.max_edge && !(*options.max_edge > 0)) {
    throw InvalidArgument(
        fmt::format("no edge is as short as {}: max_edge has to be above 0", *options.max_edge));
  }
  if (options.children < 2 || options.children > 1024) {
    throw InvalidArgument(
        fmt::format("2 to 1024 parts are merged at a time, not {}", options.children));
  }
}

HeightChoice height_choice(Heights heights) {
  switch (heights) {
    case Heights::kLowest:
      return HeightChoice::kLowest;
    case Heights::kHighest:
      return HeightChoice::kHighest;
    case Heights::kMean:
      return HeightChoice::kMean;
    case Heights::kFirst:
      break;
  }
  return HeightChoice::kFirst;
}

DivisionScheme division_scheme(Division division) {
  switch (division) {
    case Division::kCyclingAxis:
      return DivisionScheme::kCyclingAxis;
    case Division::kConstantAxis:
      return DivisionScheme::kConstantAxis;
    case Division::kLongestExtent:
      break;
  }
  return DivisionScheme::kLongestExtent;
}

StreamOptions stream_options(const TriangulateOptions& options, const Context& context,
                             RunWatch& watch) {
  StreamOptions stream;
  stream.threads = context.threads();
  stream.tile_capacity = options.tile_points;
  stream.leaf_size = options.leaf_points;
  stream.division = division_scheme(options.division);
  stream.children = options.children;
  stream.kernel = options.kernel == Kernel::kCgal ? BaseCaseKernel::kCgal : BaseCaseKernel::kOwn;
  stream.heights = height_choice(options.heights);
  stream.max_edge = options.max_edge;
  stream.input_index = options.input_index;
  stream.begin_phase = [&watch](const char* phase) { watch.begin(phase); };
  stream.end_phase = [&watch](std::uint64_t points) { watch.end(points); };
  stream.progress = [&watch](std::uint64_t points, std::optional<double> fraction) {
    watch.tell(points, fraction);
  };
  return stream;
}

/// The points of a run, and what the mesh's header says of them.
struct Input {
  PointStream* points = nullptr;
  std::optional<ProgramPoints> program{};
  MeshStreamHeader header{};
};

void open_input(spillway::PointSource& source, const TriangulateOptions& options, Input& input) {
  input.header.dimension = options.dimension;
  input.header.has_input_index = options.input_index;
  if (auto* const files = dynamic_cast<FilePoints*>(&source)) {
    if (files->dimension() != options.dimension) {
      throw InvalidArgument(fmt::format("the files were opened for {} dimensions, not for {}",
                                        files->dimension(), options.dimension));
    }
    input.points = &files->input();
    input.header.lattice = files->input().lattice();
    input.header.points = files->input().count();
    input.header.crs = files->input().crs();
    input.header.extent = files->input().world_extent();
    return;
  }
  const PointsHeader& header = input.program.emplace(source).header();
  if (options.dimension == 3 && header.coordinates == 2) {
    throw Error("the points have no z", ErrorCode::kDegenerateInput, {.remedy = Remedy::kPlane});
  }
  input.points = &*input.program;
  input.header.crs = header.crs;
  input.header.extent = input.program->extent();
}

StreamFigures run(PointStream& points, BlockSink& blocks, const Context& context,
                  const TriangulateOptions& options, RunWatch& watch) {
  MemoryBudget budget(context.memory());
  const auto scratch =
      make_scratch_folder(context.options().scratch_folder, context.scratch_limit());
  const StreamOptions stream = stream_options(options, context, watch);
  return options.dimension == 2 ? triangulate_stream<2>(points, blocks, *scratch, budget, stream)
                                : triangulate_stream<3>(points, blocks, *scratch, budget, stream);
}

}  // namespace
}  // namespace spillway::detail

namespace spillway {

Report triangulate(PointSource& source, MeshSink& sink, const TriangulateOptions& options,
                   const Context& context) {
  using namespace detail;  // NOLINT(google-build-using-namespace): the other side of the door
  check(options);
  RunWatch watch(context);
  watch.check();
  Input input;
  open_input(source, options, input);
  std::optional<SinkBlocks> to_sink;
  auto* const file = dynamic_cast<FileMesh*>(&sink);
  BlockSink& blocks = file != nullptr ? static_cast<BlockSink&>(file->open(input.header))
                                      : to_sink.emplace(sink, input.header);
  const StreamFigures figures = run(*input.points, blocks, context, options, watch);
  refuse_empty_mesh(figures, options.max_edge);
  watch.begin("write");
  blocks.finish(figures.totals);
  watch.end(figures.totals.points);
  return public_report(figures, input.points->counts());
}

}  // namespace spillway
