#include "tools/commands/terrain_input.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <limits>
#include <numeric>
#include <span>
#include <utility>
#include <vector>

#include "formats/inputs/input_kind.h"
#include "formats/inputs/open_mesh.h"
#include "formats/inputs/open_mesh_stream.h"
#include "formats/meshes/mesh_formats.h"
#include "src/parallel/parallel.h"
#include "stream/source/input_list.h"
#include "tools/options/command_options.h"
#include "tools/report/rank_statistics.h"
#include "tools/report/usage_error.h"

namespace spillway::detail {
namespace {

/// Makes x and y of all vertices integers of the mesh's lattice and returns it (heights stay as
/// they are); returns nothing, and does nothing, if there is none or if they are not on it.
std::optional<Lattice> place_on_lattice(Mesh& mesh) {
  if (!mesh.header.lattice) return std::nullopt;
  Lattice lattice = *mesh.header.lattice;
  lattice.scale[2] = 1;
  lattice.offset[2] = 0;
  std::vector<Point<3>> placed = mesh.vertices;
  for (Point<3>& vertex : placed) {
    for (int k = 0; k < 2; ++k) {
      const auto integer = lattice.to_integer(k, vertex[k]);
      if (!integer) return std::nullopt;
      vertex[k] = *integer;
    }
  }
  mesh.vertices = std::move(placed);
  return lattice;
}

void expand(Box<2>& extent, std::span<const Point<3>> vertices) {
  for (const Point<3>& vertex : vertices) extent.expand(Point<2>{vertex[0], vertex[1]});
}

class TerrainFeed {
 public:
  TerrainFeed(const TerrainOptions& options, TerrainUse& use, const TerrainTools& tools,
              RunStatistics& statistics)
      : options_(options), use_(use), tools_(tools), statistics_(statistics) {}

  void run() {
    statistics_.inputs = options_.inputs;
    statistics_.max_edge = max_edge(options_);
    if (!feed_one_input()) feed_points(disk());
    if (statistics_.stream.totals.simplices == 0) {
      if (statistics_.stream.left_out == 0) {
        throw Error(fmt::format("{}: the mesh has no {}", options_.inputs.front(), simplices()));
      }
      throw Error(fmt::format("every one of {} {} has an edge longer than {}: nothing is left",
                              statistics_.stream.left_out, simplices(), options_.max_edge));
    }
  }

 private:
  /// Feeds the input if it is a mesh. What was looked at of an input of points goes on to these.
  bool feed_one_input() {
    if (tools_.ranks != nullptr) {
      refuse_mesh();
      return false;
    }
    const std::string& path = options_.inputs.front();
    const bool several = options_.inputs.size() > 1 || stands_for_several(path);
    if (several)
      refuse_given(*options_.app, {"--mesh-format"}, "on several inputs, which are points");
    if (!options_.input.format.empty()) {
      refuse_given(*options_.app, {"--mesh-format"}, "with --input-format, which is of points");
      return false;
    }
    if (several) return false;
    if (path != "-" && !std::filesystem::exists(path)) return false;
    ProbedInput input(disk(), path);
    const InputKind kind = options_.mesh_format.empty() ? kind_of_input(input) : kind_by_format();
    if (kind == InputKind::kPoints) {
      feed_points(input);
      return true;
    }
    refuse_options_of_points();
    if (kind == InputKind::kMeshStream) {
      feed_stream(input);
    } else {
      feed_whole(read_whole(input));
    }
    return true;
  }

  void refuse_options_of_points() const {
    std::vector<std::string_view> names(kInputOptionNames.begin(), kInputOptionNames.end());
    names.insert(names.end(), kTriangulationOptionNames.begin(), kTriangulationOptionNames.end());
    names.emplace_back("--dim");
    std::erase_if(names, [&](std::string_view name) {
      return std::ranges::find(options_.own_options, name) != options_.own_options.end();
    });
    refuse_given(*options_.app, names,
                 fmt::format("on {}, which is a mesh", options_.inputs.front()));
  }

  /// Over ranks there are points only. What is none of them is said when they are opened.
  void refuse_mesh() const {
    const std::string& path = options_.inputs.front();
    if (tools_.ranks->rank() == 0 && path != "-" && std::filesystem::is_regular_file(path)) {
      ProbedInput input(disk(), path);
      if (!options_.mesh_format.empty() || kind_of_input(input) != InputKind::kPoints) {
        throw UsageError(path + " is a mesh, which one process reads: start it without mpirun");
      }
    }
  }

  [[nodiscard]] InputKind kind_by_format() const {
    const MeshFormat& format = mesh_format(options_.inputs.front(), options_.mesh_format);
    return format.is_stream() ? InputKind::kMeshStream : InputKind::kMesh;
  }

  void feed_points(FileSystem& files) {
    if (options_.dimension == 3) {
      feed_points_in<3>(files);
    } else {
      feed_points_in<2>(files);
    }
  }

  template <int D>
  void feed_points_in(FileSystem& files) {
    statistics_.dimension = D;
    StreamOptions stream = stream_options(options_, tools_.progress);
    const auto source =
        make_point_source(files, options_.inputs, options_.input,
                          {.dimension = D, .memory = tools_.budget.limit(), .ranks = tools_.ranks},
                          tools_.scratch, tools_.progress);
    check_heights(options_, *source);
    if (use_.needs_heights() && !source->has_heights()) {
      throw Error(
          fmt::format("{}: the points have no z: name the column of heights z, or give "
                      "points that have heights",
                      options_.inputs.front()));
    }
    BlockSink& sink = use_.begin({D, source->lattice(), source->crs(), std::nullopt});
    stream.extent_known = [this](const Box<2>& extent, std::uint64_t points) {
      use_.extent_known(extent, points);
    };
    if (tools_.ranks != nullptr) {
      const RankMesh mesh = triangulate_over_ranks<D>(*source, sink, tools_.scratch, tools_.budget,
                                                      stream, *tools_.ranks);
      for (const MergedPart& part : mesh.merged) use_.add_merged(part);
      statistics_.input = source->counts();
      share_statistics(statistics_, mesh, *tools_.ranks);
    } else {
      statistics_.stream =
          triangulate_stream<D>(*source, sink, tools_.scratch, tools_.budget, stream);
      statistics_.input = source->counts();
    }
    statistics_.on_lattice = source->lattice().has_value();
    if (statistics_.input.dropped() > 0) tools_.progress.say(describe(statistics_.input));
    sink.finish(statistics_.stream.totals);
  }

  void feed_stream(ProbedInput& input) {
    std::string path = input.path();
    std::unique_ptr<ScratchFile> copy;
    FileSystem* files = &input;
    if (use_.wants_extent() && input.is_pipe()) {
      copy = copy_to_scratch(*input.open(path));
      path = copy->name();
      files = &disk();
    }
    Box<2> extent;
    std::uint64_t vertices = 0;
    if (use_.wants_extent()) {
      vertices = find_extent(*open_mesh_stream_reader(*files, path, options_.mesh_format), extent);
      files = &disk();
    }
    const auto reader = open_mesh_stream_reader(*files, path, options_.mesh_format);
    const MeshStreamHeader& header = reader->header();
    check_dimension(header.dimension);
    BlockSink& sink =
        use_.begin({header.dimension, header.lattice, header.crs, statistics_.max_edge});
    use_.extent_known(extent, vertices);
    tools_.progress.begin(simplices(), simplices());
    with_threads(tools_.threads, [&] { pass_on(*reader, sink); });
    statistics_.stream.triangulate_seconds = tools_.progress.end(reader->totals().simplices);
    statistics_.stream.totals = reader->totals();
    statistics_.on_lattice = header.lattice.has_value();
    sink.finish(reader->totals());
  }

  std::uint64_t find_extent(MeshStreamReader& reader, Box<2>& extent) {
    if (reader.header().dimension != 2) return 0;
    tools_.progress.begin("extent", "vertices");
    std::uint64_t vertices = 0;
    for (MeshBlock block; reader.read(block);) {
      expand(extent, block.vertices);
      tools_.progress.update(vertices += block.vertices.size(), reader.fraction_read());
    }
    tools_.progress.end(vertices);
    return vertices;
  }

  /// Several blocks are absorbed at a time.
  void pass_on(MeshStreamReader& reader, BlockSink& sink) {
    struct Slot {
      MeshBlock block;
      std::size_t triangles = 0;
    };
    std::vector<Slot> slots(tools_.threads + 1);
    std::uint64_t done = 0;
    const auto source = [&](std::size_t slot) {
      auto& [block, triangles] = slots[slot];
      block.clear();
      const bool more = reader.read(block);
      triangles = block.corners.size() / corners_per_simplex();
      return more;
    };
    const std::vector<PipelineStage> stages = {
        {.in_order = false, .work = [&](std::size_t slot) { sink.absorb(slots[slot].block); }},
        {.in_order = true, .work = [&](std::size_t slot) {
           sink.write(std::move(slots[slot].block));
           tools_.progress.update(done += slots[slot].triangles, reader.fraction_read());
         }}};
    run_pipeline(slots.size(), source, stages);
  }

  Mesh read_whole(ProbedInput& input) {
    tools_.progress.begin("read mesh", "simplices");
    Mesh mesh = read_mesh(input, input.path(), options_.mesh_format);
    tools_.progress.end(mesh.corners.size() / mesh.corners_per_simplex());
    return mesh;
  }

  void feed_whole(Mesh mesh) {
    check_dimension(mesh.header.dimension);
    if (mesh.vertices.size() > std::numeric_limits<std::uint32_t>::max()) {
      throw Error(
          fmt::format("{} vertices are too many for a mesh that is no stream; convert it to spm "
                      "from the points",
                      mesh.vertices.size()));
    }
    const std::optional<Lattice> lattice = place_on_lattice(mesh);
    Box<2> extent;
    expand(extent, mesh.vertices);
    MeshTotals& totals = statistics_.stream.totals;
    totals.vertices = totals.points = mesh.vertices.size();
    totals.simplices = mesh.corners.size() / corners_per_simplex();
    statistics_.on_lattice = lattice.has_value();
    BlockSink& sink =
        use_.begin({mesh.header.dimension, lattice, mesh.header.crs, statistics_.max_edge});
    use_.extent_known(extent, mesh.vertices.size());
    MeshBlock block;
    block.vertices = std::move(mesh.vertices);
    block.corners.assign(mesh.corners.begin(), mesh.corners.end());
    block.finalized.resize(block.vertices.size());
    std::iota(block.finalized.begin(), block.finalized.end(), 0U);
    mesh = {};
    tools_.progress.begin(simplices(), simplices());
    with_threads(tools_.threads, [&] {
      sink.absorb(block);
      sink.write(std::move(block));
    });
    statistics_.stream.triangulate_seconds = tools_.progress.end(totals.simplices);
    sink.finish(totals);
  }

  [[nodiscard]] const char* simplices() const {
    return statistics_.dimension == 2 ? "triangles" : "tetrahedra";
  }
  [[nodiscard]] std::size_t corners_per_simplex() const { return statistics_.dimension + 1; }

  void check_dimension(int dimension) {
    statistics_.dimension = dimension;
    if (dimension == 2 || options_.tetrahedra) return;
    throw Error(options_.inputs.front() +
                ": a terrain is a mesh of triangles, and this one is of tetrahedra");
  }

  std::unique_ptr<ScratchFile> copy_to_scratch(InputFile& input) {
    auto copy = tools_.scratch.create("mesh");
    std::vector<std::byte> piece(std::size_t{1} << 20);
    tools_.progress.begin("copy", "bytes");
    while (const std::size_t got = input.read(piece)) {
      copy->append(std::span(piece).first(got));
      tools_.progress.update(copy->size(), std::nullopt);
    }
    tools_.progress.end(copy->size());
    return copy;
  }

  const TerrainOptions& options_;
  TerrainUse& use_;
  const TerrainTools& tools_;
  RunStatistics& statistics_;
};

}  // namespace

void add_terrain_options(CommandLine& app, TerrainOptions& options) {
  app.add_option("IN", options.inputs, "Point files, as `triangulate` takes them, or one mesh")
      .required();
  add_triangulation_options(app, options);
  add_choice(app, "--mesh-format", options.mesh_format, mesh_format_names(),
             "Format of a mesh, where neither content nor name tell");
}

void feed_terrain(const TerrainOptions& options, TerrainUse& use, const TerrainTools& tools,
                  RunStatistics& statistics) {
  TerrainFeed(options, use, tools, statistics).run();
}

}  // namespace spillway::detail
