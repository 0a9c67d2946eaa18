#include "stream/library/tiling/mesh_tiles.h"

#include <tuple>

#include "formats/disk/file_system.h"
#include "formats/meshes/mesh_stream_writer.h"
#include "formats/meshes/vector/vector_format.h"
#include "stream/checker/checker.h"
#include "stream/library/meshes/engine_sink.h"
#include "stream/library/meshes/mesh_passage.h"

namespace spillway::stream {

MeshTiles::MeshTiles(const MeshStreamHeader& header, MeshTiling& tiling, std::uint64_t memory,
                     ScratchFolder& scratch)
    : header_(header),
      tiling_(tiling),
      scratch_(scratch),
      records_("tiles", memory, scratch),
      divider_(header, tiling, records_) {}

void MeshTiles::write_tile(std::size_t tile, const MeshFormat& format, const Context& context,
                           RunWatch& watch, Written& written) {
  const std::string& path = written.paths.emplace_back(tiling_.path(tile));
  const TileCounts& counts = divider_.counts(tile);
  TileMesh mesh(header_, counts, records_, tile);
  MeshTotals& totals = written.totals = mesh.totals();
  if (format.has_totals || counts_) {
    TileMesh same(header_, counts, records_, tile);
    CheckerOptions how;
    how.threads = context.threads();
    const CheckReport counted = count_mesh_stream(same, how);
    totals.canonical_hash = counted.canonical_hash;
    totals.hull_facets = counted.hull_facets;
  }
  if (&format == &kGpkgMesh) tell_lost_layers(kGeoPackage, path, context);
  const auto writer = open_mesh_stream_writer(disk(), path, format, mesh.header(), scratch_);
  pass_mesh(mesh, header_.attributes, *writer, watch, context.threads());
  writer->finish(totals);
  written.bytes += writer->bytes_written();
}

MeshTiles::Written MeshTiles::write(const MeshFormat& format, bool counted, const Context& context,
                                    RunWatch& watch) {
  counts_ = counted;
  const std::vector<std::size_t> tiles = records_.tiles();
  std::ignore = tiling_.paths(tiles);  // which are different ones
  Written written;
  for (const std::size_t tile : tiles) write_tile(tile, format, context, watch, written);
  return written;
}

}  // namespace spillway::stream
