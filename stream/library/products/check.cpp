#include <spillway/check.h>

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <optional>

#include "formats/disk/scratch_folder.h"
#include "formats/points/attributes/further_coordinates.h"
#include "src/error.h"
#include "src/geometry/torus.h"
#include "stream/checker/checker.h"
#include "stream/library/context/context_state.h"
#include "stream/library/context/run_watch.h"
#include "stream/library/meshes/opened_mesh.h"
#include "stream/library/meshes/program_mesh.h"
#include "stream/library/own_parts.h"
#include "stream/library/points/engine_points.h"
#include "stream/library/points/program_points.h"
#include "stream/library/products/point_comparison.h"
#include "stream/periodic/periodic_points.h"

namespace spillway::stream {
namespace {

/// The points that the vertices are compared with, if there are any; their lattice is noted for the
/// proof.
class Comparison {
 public:
  Comparison(PointSource* source, int dimension, const Context& context, RunWatch& watch,
             CheckerOptions& how)
      : watch_(watch), dimension_(dimension) {
    if (source == nullptr) return;
    auto* points = OwnParts::of(*source);
    if (points == nullptr) points = &program_points_.emplace(*source, dimension);
    const RunPoints run = points->begin(watch, true);
    const bool is_higher = further_axes(dimension) > 0;
    if (run.dimension != dimension && (run.dimension != 0 || is_higher)) {
      throw InvalidArgument(
          fmt::format("the points were opened for {} dimensions, and the mesh "
                      "has {}",
                      run.dimension, dimension));
    }
    input_ = run.stream;
    how.input_lattice = input_->lattice();
    scratch_ = context.state().scratch(context);
    vertices_.emplace(dimension, context.memory(), *scratch_);
    how.vertex = [this](const WorldPoint& vertex, std::span<const std::byte> further) {
      vertices_->add_vertex(vertex, further);
    };
  }
  Comparison(const Comparison&) = delete;
  Comparison& operator=(const Comparison&) = delete;

  /// `periodic` is the box of the mesh, into which points are brought.
  void run(const std::optional<PeriodicBox>& periodic, const CheckerOptions& how,
           CheckReport& report) {
    if (input_ == nullptr) return;
    if (periodic) {
      const std::optional<IntegerLattice>& lattice = input_->lattice();
      const Torus torus =
          lattice ? Torus(*periodic, dimension_, *lattice) : Torus(*periodic, dimension_);
      PeriodicCopies no_copies(torus);
      PeriodicPoints wrapped(*input_, no_copies);
      vertices_->compare(wrapped, how, report, watch_);
      report.points = wrapped.counts();
      return;
    }
    vertices_->compare(*input_, how, report, watch_);
    report.points = input_->counts();
  }

 private:
  RunWatch& watch_;
  const int dimension_;
  std::optional<ProgramPoints> program_points_;
  PointStream* input_ = nullptr;
  std::shared_ptr<ScratchFolder> scratch_;
  std::optional<PointComparison> vertices_;
};

CheckReport check_whole(const Mesh& mesh, CheckerOptions& how, PointSource* points,
                        const Context& context, RunWatch& watch) {
  Comparison comparison(points, mesh.header.dimension, context, watch, how);
  watch.begin("check", "simplices");
  CheckReport report = check_mesh(mesh, how);
  if (how.vertex) {
    const std::size_t record = mesh.header.attributes.record_size();
    const std::size_t further =
        static_cast<std::size_t>(further_axes(mesh.header.dimension)) * sizeof(double);
    for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
      how.vertex(mesh.vertices[v], std::span(mesh.attributes).subspan(v * record, further));
    }
  }
  watch.end(report.simplices);
  comparison.run(mesh.header.periodic, how, report);
  return report;
}

CheckReport check_stream(MeshStreamReader& reader, CheckerOptions& how, PointSource* points,
                         const Context& context, RunWatch& watch) {
  Comparison comparison(points, reader.header().dimension, context, watch, how);
  how.progress = [&watch](std::uint64_t simplices, std::optional<double> fraction) {
    watch.tell(simplices, fraction);
  };
  watch.begin("check", "simplices");
  CheckReport report = check_mesh_stream(reader, how);
  watch.end(report.simplices);
  comparison.run(reader.header().periodic, how, report);
  return report;
}

}  // namespace
}  // namespace spillway::stream

namespace spillway {

CheckReport check(MeshSource& mesh, const CheckOptions& options, const Context& context,
                  PointSource* points) {
  stream::RunWatch watch(context);
  watch.check();
  checker::CheckerOptions how;
  static_cast<CheckOptions&>(how) = options;
  how.threads = context.threads();
  auto* const file = stream::OwnParts::of(mesh);
  if (file == nullptr) {
    stream::ProgramMesh reader(mesh);
    return stream::check_stream(reader, how, points, context, watch);
  }
  file->take();
  if (file->is_stream()) return stream::check_stream(file->stream(), how, points, context, watch);
  return stream::check_whole(file->whole(watch), how, points, context, watch);
}

}  // namespace spillway
