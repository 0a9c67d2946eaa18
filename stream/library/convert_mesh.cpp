#include <spillway/convert.h>

#include <fmt/format.h>

#include <cstdint>
#include <optional>

#include "formats/points/attributes/further_coordinates.h"
#include "src/error.h"
#include "src/geometry/simplex_name.h"
#include "stream/library/context/context_state.h"
#include "stream/library/given_crs.h"
#include "stream/library/meshes/mesh_passage.h"
#include "stream/library/meshes/opened_mesh.h"
#include "stream/library/meshes/program_mesh.h"
#include "stream/library/meshes/program_sink.h"
#include "stream/library/own_parts.h"

namespace spillway::stream {
namespace {

Report convert(MeshStreamReader& reader, const std::string& name,
               const std::optional<VertexExtent>& extent, const std::string& crs, EngineSink& sink,
               const Context& context, RunWatch& watch) {
  const int dimension = reader.header().dimension;
  const AttributeLayout& there = reader.header().attributes;
  sink.check_attributes(there);
  MeshStart start{.header = reader.header(), .name = name};
  start.header.attributes =
      chosen_beside_coordinates(there, sink.wanted_attributes(false), dimension);
  start.header.crs = crs;
  BlockSink& blocks = sink.start(start);
  if (extent) sink.extent_known(extent->box, extent->vertices);
  watch.begin(simplices_of(dimension), simplices_of(dimension));
  const std::uint64_t simplices = pass_mesh(reader, start.header.attributes, blocks, watch,
                                            sink.feeding_threads(context.threads()));
  Report report;
  report.dimension = dimension;
  report.triangulate_seconds = watch.end(simplices);
  report.mesh = reader.totals();
  report.lost = sink.lost_attributes(there, false);
  report.on_lattice = reader.header().lattice.has_value();
  if (sink.is_product() && report.mesh.simplices == 0) {
    throw Failure(fmt::format("{}: the mesh has no {}", name, simplices_of(dimension)),
                  ErrorCode::kDegenerateInput, {.file = name});
  }
  if (!reader.has_hash() && sink.tells_hash()) {
    throw InvalidArgument(fmt::format(
        "{}: its totals tell no canonical hash and hull facets, with which the file would end",
        name));
  }
  sink.complete(watch, report);
  if (!sink.is_product()) watch.close(report.mesh.simplices);
  return report;
}

}  // namespace
}  // namespace spillway::stream

namespace spillway {

Report convert(MeshSource& source, MeshSink& sink, const Context& context) {
  using namespace stream;  // NOLINT(google-build-using-namespace): the other side of the door
  RunWatch watch(context);
  watch.check();
  std::optional<ProgramSink> program_sink;
  auto* target = OwnParts::of(sink);
  if (target == nullptr) target = &program_sink.emplace(sink);
  if (!target->is_product()) watch.open("convert", "simplices");
  std::optional<VertexExtent> extent;
  if (auto* const file = OwnParts::of(source)) {
    file->take();
    if (target->tells_hash()) file->check_totals(watch);
    if (target->wants_extent()) extent = file->find_extent(watch);
    MeshStreamReader& reader = file->reader(watch, !target->is_product());
    if (!target->is_product()) file->tell_of_dropped_lattice();
    const std::string crs = crs_of_mesh(file->path(), reader.header().crs, file->crs_choice(),
                                        target->crs_need(), context);
    return stream::convert(reader, file->path(), extent, crs, *target, context, watch);
  }
  ProgramMesh reader(source);
  if (target->wants_extent() && reader.header().dimension == 2) {
    if (!reader.header().extent) {
      throw InvalidArgument("the header of the mesh must tell its extent");
    }
    extent = {plane_of(*extent_of_blocks(reader.header())), reader.header().points.value_or(0)};
  }
  return stream::convert(reader, "the mesh", extent, reader.header().crs, *target, context, watch);
}

}  // namespace spillway
