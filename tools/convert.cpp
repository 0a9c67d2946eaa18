#include <fmt/format.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <limits>
#include <memory>
#include <numeric>
#include <string>
#include <utility>

#include "formats/bytes.h"
#include "formats/input_kind.h"
#include "formats/mesh_reader.h"
#include "formats/mesh_stream.h"
#include "formats/mesh_stream_writer.h"
#include "formats/spm_format.h"
#include "src/error.h"
#include "tools/checker.h"
#include "tools/command.h"
#include "tools/command_options.h"
#include "tools/facet_count.h"

namespace spillway {
namespace {

constexpr const char* kExamples =
    "Examples:\n"
    "  spillway convert tin.spm -o tin.ply\n"
    "  spillway convert tin.vtu -o tin.spm\n"
    "  spillway triangulate survey.las -o - | spillway convert - -o tin.obj\n"
    "An spm stream of any length is converted in the memory of its border; other formats are read "
    "as a whole.";

struct ConvertOptions {
  std::string input;
  std::string input_format;
  std::string output;
  std::string output_format;
  MemoryOptions memory;
  ReportOptions report;
};

/// Passes the blocks of a stream on as they come.
MeshTotals convert_stream(MeshStreamReader& reader, MeshFormat format,
                          const ConvertOptions& options, ScratchFolder& scratch,
                          Progress& progress) {
  const auto writer =
      open_mesh_stream_writer(disk(), options.output, format, reader.header(), scratch);
  std::uint64_t simplices = 0;
  for (MeshBlock block; reader.read(block); block = {}) {
    simplices += block.corners.size() / (reader.header().dimension + 1);
    writer->write(std::move(block));
    progress.update(simplices, reader.fraction_read());
  }
  writer->finish(reader.totals());
  return reader.totals();
}

MeshTotals totals_of(const Mesh& mesh) {
  MeshTotals totals;
  totals.vertices = mesh.vertices.size();
  totals.simplices = mesh.corners.size() / mesh.corners_per_simplex();
  totals.hull_facets = count_boundary_facets(mesh);
  totals.points = totals.vertices;
  totals.canonical_hash = canonical_hash(mesh);
  return totals;
}

/// The vertices as a stream with this lattice has them. A height need not be on it.
std::vector<Point<3>> stream_vertices(const Mesh& mesh, std::optional<Lattice>& lattice) {
  std::vector<Point<3>> vertices = mesh.vertices;
  if (!lattice) return vertices;
  if (mesh.header.dimension == 2) {
    lattice->scale[2] = 1;
    lattice->offset[2] = 0;
  }
  for (Point<3>& vertex : vertices) {
    for (int k = 0; k < mesh.header.dimension; ++k) {
      const auto integer = lattice->to_integer(k, vertex[k]);
      if (!integer) {
        lattice.reset();
        return mesh.vertices;
      }
      vertex[k] = *integer;
    }
  }
  return vertices;
}

/// Writes a whole mesh as one block.
MeshTotals convert_whole(const Mesh& mesh, MeshFormat format, const ConvertOptions& options,
                         ScratchFolder& scratch) {
  if (mesh.vertices.size() > std::numeric_limits<std::uint32_t>::max()) {
    throw Error(fmt::format("{}: {} vertices are too many to convert at once", options.input,
                            mesh.vertices.size()));
  }
  MeshStreamHeader header;
  header.dimension = mesh.header.dimension;
  header.has_input_index = mesh.header.has_input_index;
  header.lattice = mesh.header.lattice;
  header.crs = mesh.header.crs;
  MeshBlock block;
  block.vertices = stream_vertices(mesh, header.lattice);
  block.input_index = mesh.input_index;
  block.corners.assign(mesh.corners.begin(), mesh.corners.end());
  block.finalized.resize(mesh.vertices.size());
  std::iota(block.finalized.begin(), block.finalized.end(), 0U);
  const auto writer = open_mesh_stream_writer(disk(), options.output, format, header, scratch);
  const MeshTotals totals = totals_of(mesh);
  writer->write(std::move(block));
  writer->finish(totals);
  return totals;
}

/// Whether the mesh is to be read block by block: an spm stream. An sma stream has no hash at its
/// end, so that is computed of the whole.
bool is_stream(ProbedInput& input, InputKind kind) {
  return kind == InputKind::kMeshStream &&
         as_text(input.source().peek(kSpmMagic.size())) == kSpmMagic;
}

int run(const ConvertOptions& options) {
  const MeshFormat format = mesh_format(options.output, options.output_format);
  if (options.output == "-" && ::isatty(STDOUT_FILENO) != 0 && options.output_format.empty()) {
    throw UsageError("a mesh stream is nothing for a terminal: name a file, or pipe it on");
  }
  Progress progress = make_progress(options.report, options.input == "-");
  const auto scratch = make_scratch_folder(options.memory);
  ProbedInput input(disk(), options.input);
  progress.begin("convert", "simplices");
  MeshTotals totals;
  const InputKind kind =
      options.input_format.empty() ? kind_of_input(input) : InputKind::kMeshStream;
  if (is_stream(input, kind)) {
    const auto reader = open_mesh_stream_reader(input, options.input, options.input_format);
    totals = convert_stream(*reader, format, options, *scratch, progress);
  } else {
    if (kind == InputKind::kPoints) {
      throw Error(options.input + ": these are points, and only meshes are converted");
    }
    totals = convert_whole(read_mesh(input, options.input, options.input_format), format, options,
                           *scratch);
  }
  progress.update(totals.simplices, 1);
  progress.end();
  progress.say(fmt::format("{} vertices, {} simplices in {}", totals.vertices, totals.simplices,
                           options.output == "-" ? "standard output" : options.output));
  return kExitDone;
}

}  // namespace

Subcommand add_convert(CLI::App& root) {
  const auto options = std::make_shared<ConvertOptions>();
  CLI::App* app = root.add_subcommand("convert", "Write a mesh in another format");
  app->footer(kExamples);
  app->add_option("MESH", options->input, "Mesh file; - is a mesh stream from a pipe")->required();
  app->add_option("-o,--output", options->output, "Mesh file; - is standard output, as spm")
      ->required()
      ->type_name("FILE");
  add_choice(*app, "--mesh-format", options->input_format, mesh_format_names(),
             "Format of the input, where neither content nor name tell");
  add_choice(*app, "--output-format", options->output_format, mesh_format_names(),
             "Format of the output, where the name does not tell");
  add_memory_options(*app, options->memory);
  add_report_options(*app, options->report);
  return {app, [options] { return run(*options); }};
}

}  // namespace spillway
