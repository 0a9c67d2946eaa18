#include "tools/commands/convert_meshes.h"

#include <fmt/format.h>
#include <unistd.h>

#include <limits>
#include <numeric>
#include <optional>
#include <utility>
#include <vector>

#include "formats/inputs/open_mesh.h"
#include "formats/inputs/open_mesh_stream.h"
#include "formats/meshes/common/mesh_stream.h"
#include "formats/meshes/mesh_formats.h"
#include "formats/meshes/mesh_stream_writer.h"
#include "stream/checker/checker.h"
#include "tools/commands/facet_count.h"
#include "tools/report/usage_error.h"

namespace spillway::detail {
namespace {

/// Passes the blocks of a stream on as they come.
MeshTotals convert_stream(MeshStreamReader& reader, const MeshFormat& format,
                          const std::string& output, ScratchFolder& scratch, Progress& progress) {
  const auto writer = open_mesh_stream_writer(disk(), output, format, reader.header(), scratch);
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

/// The vertices with their first `axes` axes on the lattice; nothing if one is not on it.
std::optional<std::vector<Point<3>>> on_lattice(const Mesh& mesh, const Lattice& lattice,
                                                int axes) {
  std::vector<Point<3>> vertices = mesh.vertices;
  for (Point<3>& vertex : vertices) {
    for (int k = 0; k < axes; ++k) {
      const auto integer = lattice.to_integer(k, vertex[k]);
      if (!integer) return std::nullopt;
      vertex[k] = *integer;
    }
  }
  return vertices;
}

/// The vertices as a stream with this lattice has them. In the plane heights need not be on it;
/// then they have the identity map.
std::vector<Point<3>> stream_vertices(const Mesh& mesh, std::optional<Lattice>& lattice) {
  if (!lattice) return mesh.vertices;
  if (auto vertices = on_lattice(mesh, *lattice, 3)) return *std::move(vertices);
  if (mesh.header.dimension == 2) {
    lattice->scale[2] = 1;
    lattice->offset[2] = 0;
    if (auto vertices = on_lattice(mesh, *lattice, 2)) return *std::move(vertices);
  }
  lattice.reset();
  return mesh.vertices;
}

/// Writes a whole mesh as one block.
MeshTotals convert_whole(const Mesh& mesh, const MeshFormat& format, const std::string& input,
                         const std::string& output, ScratchFolder& scratch) {
  if (mesh.vertices.size() > std::numeric_limits<std::uint32_t>::max()) {
    throw Error(fmt::format("{}: {} vertices are too many to convert at once", input,
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
  const auto writer = open_mesh_stream_writer(disk(), output, format, header, scratch);
  const MeshTotals totals = totals_of(mesh);
  writer->write(std::move(block));
  writer->finish(totals);
  return totals;
}

/// What a mesh was written to, in words.
std::string files_of(const std::string& output, const MeshFormat& format) {
  if (output == "-") return "standard output";
  return format.file_set != nullptr ? format.file_set->names(output) : output;
}

/// Whether the mesh is to be read block by block. Where a stream has no hash at its end, that is
/// computed of the whole.
bool is_stream(ProbedInput& input, InputKind kind) {
  if (kind != InputKind::kMeshStream) return false;
  const MeshFormat* const format = mesh_format_of_content(input.source());
  return format != nullptr && format->has_totals;
}

}  // namespace

void convert_mesh(ProbedInput& input, InputKind kind, const MeshConversion& conversion,
                  ScratchFolder& scratch, Progress& progress) {
  const std::string& output = conversion.output;
  const MeshFormat& format = mesh_format(output, conversion.output_format);
  if (output == "-" && ::isatty(STDOUT_FILENO) != 0 && conversion.output_format.empty()) {
    throw UsageError("a mesh stream is nothing for a terminal: name a file, or pipe it on");
  }
  progress.begin("convert", "simplices");
  MeshTotals totals;
  if (is_stream(input, kind)) {
    const auto reader = open_mesh_stream_reader(input, input.path(), conversion.input_format);
    totals = convert_stream(*reader, format, output, scratch, progress);
  } else {
    totals = convert_whole(read_mesh(input, input.path(), conversion.input_format), format,
                           input.path(), output, scratch);
  }
  progress.end(totals.simplices);
  progress.say(fmt::format("{} vertices, {} simplices in {}", totals.vertices, totals.simplices,
                           files_of(output, format)));
  if (const std::string note = rounding_note(format); !note.empty()) progress.say(note);
}

}  // namespace spillway::detail
