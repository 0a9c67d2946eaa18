#include <spillway/info.h>
#include <spillway/input.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "formats/bytes/bytes.h"
#include "formats/points/attributes/further_coordinates.h"
#include "src/error.h"
#include "src/geometry/box.h"
#include "src/geometry/lattice.h"
#include "src/geometry/lattice_check.h"
#include "stream/library/context/run_watch.h"
#include "stream/library/meshes/opened_mesh.h"
#include "stream/library/meshes/whole_mesh.h"
#include "stream/library/points/opened_points.h"
#include "stream/library/products/attribute_statistics.h"
#include "stream/source/input_regions.h"

namespace spillway::stream {
namespace {

std::optional<Extent> extent_of(const Box<3>& box) {
  if (box.empty()) return std::nullopt;
  Extent extent{box.lo, box.hi};
  for (std::size_t k = 0; k < 3; ++k) {
    extent.low[k] += 0.0;  // -0 becomes 0
    extent.high[k] += 0.0;
  }
  return extent;
}

std::optional<LatticeInfo> lattice_info(const std::optional<IntegerLattice>& lattice) {
  if (!lattice) return std::nullopt;
  return LatticeInfo{lattice->scale, lattice->offset};
}

/// Counts points that lie outside of the box that a header tells.
class OutsidePoints {
 public:
  explicit OutsidePoints(const PointHeader& header) : box_(extent_told_by(header)) {
    if (!box_) return;
    box_ = with_a_step_more(*box_, header.lattice);
    axes_ = header.coordinates;
  }

  void add(const Point<3>& point) {
    for (int k = 0; k < axes_; ++k) {
      if (point[k] >= box_->lo[k] && point[k] <= box_->hi[k]) continue;
      ++count_;
      return;
    }
  }
  [[nodiscard]] std::uint64_t count() const { return count_; }

 private:
  std::optional<Box<3>> box_;
  int axes_ = 0;  ///< to look at
  std::uint64_t count_ = 0;
};

/// The ranges of coordinates beyond z.
class FurtherExtent {
 public:
  explicit FurtherExtent(int dimension)
      : ranges_(
            static_cast<std::size_t>(further_axes(dimension)),
            {std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()}) {}

  /// Takes a record that begins with them.
  void add(std::span<const std::byte> record) {
    for (std::size_t k = 0; k < ranges_.size(); ++k) {
      const auto coordinate = load<double>(record.data() + k * sizeof(double));
      ranges_[k] = {std::min(ranges_[k][0], coordinate), std::max(ranges_[k][1], coordinate)};
    }
  }

  [[nodiscard]] const std::vector<std::array<double, 2>>& ranges() const { return ranges_; }

 private:
  std::vector<std::array<double, 2>> ranges_;
};

std::unique_ptr<OpenedPoints> open_one(const std::string& path, const PointOptions& options,
                                       const Context& context) {
  if (spillway::stands_for_several(path)) {
    throw InvalidArgument(path + ": this stands for several files; describe one by one");
  }
  return std::make_unique<OpenedPoints>(std::vector{path}, options, context);
}

TableInfo table_info(const TextFacts& text) {
  TableInfo table;
  table.separator = text.separator;
  table.decimal = text.decimal;
  table.names = text.names;
  for (const int column : text.columns) table.columns.push_back(column + 1);
  for (const auto& [first, end] : text.characters) {
    table.characters.push_back({static_cast<int>(first) + 1, static_cast<int>(end)});
  }
  table.counts_downwards = text.counts_downwards;
  table.first_line = text.first_line;
  table.first_rows = text.first_rows;
  return table;
}

PointsInfo told_by(const PointHeader& header) {
  PointsInfo info;
  info.format = header.format;
  info.version = header.version;
  info.point_format = header.point_format;
  info.coordinates = header.coordinates;
  info.header_points = header.count;
  info.lattice = lattice_info(header.lattice);
  info.crs = header.crs;
  info.crs_note = header.crs_note;
  info.software = header.software;
  if (!header.regions.empty()) {
    info.cells = std::max<std::uint64_t>(header.cells, header.regions.size());
  }
  if (const auto told = extent_told_by(header)) info.header_box = extent_of(*told);
  info.attributes = header.attributes.attributes();
  if (header.text) info.table = table_info(*header.text);
  return info;
}

MeshInfo describe_whole(OpenedMesh& file, RunWatch& watch) {
  watch.begin("read", "vertices");
  const Mesh mesh = file.read_whole();
  watch.end(mesh.vertices.size());
  MeshInfo info;
  info.format = mesh.format;
  info.dimension = mesh.header.dimension;
  info.has_input_index = mesh.header.has_input_index;
  info.totals.vertices = mesh.vertices.size();
  info.totals.simplices = mesh.corners.size() / mesh.corners_per_simplex();
  info.totals.hull_facets = count_boundary_facets(mesh);
  info.totals.canonical_hash = canonical_hash(mesh);
  info.extent = extent_of(box_around(mesh.vertices));
  FurtherExtent further(mesh.header.dimension);
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
    further.add(std::span(mesh.attributes).subspan(v * mesh.header.attributes.record_size()));
  }
  if (info.extent) info.further_extent = further.ranges();
  info.lattice = lattice_info(mesh.header.lattice);
  info.crs = mesh.header.crs;
  info.attributes = mesh.header.attributes.attributes();
  info.periodic = mesh.header.periodic;
  return info;
}

/// Holds no more of the stream than its open border.
MeshInfo describe_stream(OpenedMesh& file, RunWatch& watch) {
  MeshStreamReader& reader = file.stream();
  Box<3> box;
  FurtherExtent further_box(reader.header().dimension);
  CheckerOptions options;
  options.vertex = [&](const WorldPoint& vertex, std::span<const std::byte> further) {
    box.expand(vertex);
    further_box.add(further);
  };
  options.progress = [&watch](std::uint64_t simplices, std::optional<double> fraction) {
    watch.tell(simplices, fraction);
  };
  watch.begin("read", "simplices");
  const CheckReport found = count_stream(reader, options, file.path());
  watch.end(found.simplices);
  MeshInfo info;
  info.format = file.format()->name;
  info.dimension = reader.header().dimension;
  info.has_input_index = reader.header().has_input_index;
  info.tells_totals = reader.has_hash();
  if (info.tells_totals) info.totals = reader.totals();
  info.totals.vertices = found.vertices;
  info.totals.simplices = found.simplices;
  info.totals.hull_facets = found.hull_facets;
  info.totals.canonical_hash = found.canonical_hash;
  info.extent = extent_of(box);
  if (info.extent) info.further_extent = further_box.ranges();
  info.lattice = lattice_info(reader.header().lattice);
  info.crs = reader.header().crs;
  info.attributes = reader.header().attributes.attributes();
  info.periodic = reader.header().periodic;
  info.peak_live_vertices = found.peak_live_vertices;
  return info;
}

}  // namespace
}  // namespace spillway::stream

namespace spillway {

PointsInfo describe_points(const std::string& path, const PointOptions& options,
                           const Context& context) {
  using namespace stream;  // NOLINT(google-build-using-namespace): the other side of the door
  RunWatch watch(context);
  watch.check();
  const auto points = open_one(path, options, context);
  points->begin(watch, false);
  stream::JoinedInputs& source = points->input();
  source.carry({.all = true});
  const PointHeader header = source.headers().front();
  const std::optional<geometry::IntegerLattice>& lattice = source.lattice();
  Box<3> box;
  OutsidePoints outside(header);
  AttributeStatistics attributes(source.attributes());
  PointBlock block;
  watch.begin("read", "points");
  while (source.read(block)) {
    for (const LatticePoint& point : block.points) {
      const WorldPoint place = in_world(lattice, point);
      box.expand(place);
      outside.add(place.numbers());
    }
    attributes.add(block.attributes);
    watch.tell(source.points_read(), source.fraction_read());
  }
  watch.end(source.points_read());
  PointsInfo info = told_by(header);
  info.counts = source.counts();
  info.extent = extent_of(box);
  info.points_outside = outside.count();
  info.attributes = source.attributes().attributes();
  info.ranges = attributes.ranges();
  info.classes = attributes.classes();
  info.returns = attributes.returns();
  info.flags = attributes.flags();
  return info;
}

PointsInfo describe_header(const std::string& path, const PointOptions& options,
                           const Context& context) {
  using namespace stream;  // NOLINT(google-build-using-namespace): the other side of the door
  const auto points = open_one(path, options, context);
  const PointHeader header = points->input().headers().front();
  PointsInfo info = told_by(header);
  info.extent = info.header_box;
  return info;
}

MeshInfo describe_mesh(const std::string& path, const MeshOptions& options,
                       const Context& context) {
  using namespace stream;  // NOLINT(google-build-using-namespace): the other side of the door
  RunWatch watch(context);
  watch.check();
  OpenedMesh file(path, options, context);
  return file.is_stream() ? describe_stream(file, watch) : describe_whole(file, watch);
}

}  // namespace spillway
