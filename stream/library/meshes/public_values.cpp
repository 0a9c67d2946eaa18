#include "stream/library/meshes/public_values.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <set>
#include <span>
#include <utility>

#include "formats/meshes/common/mesh_block.h"
#include "formats/meshes/common/stream_numbers.h"
#include "formats/points/attributes/further_coordinates.h"
#include "src/error.h"
#include "src/geometry/dimensions.h"
#include "src/geometry/lattice_check.h"
#include "src/geometry/torus.h"
#include "stream/library/points/attribute_records.h"
#include "stream/library/points/public_points.h"

namespace spillway::stream {

MeshHeader public_header(const MeshStreamHeader& header) {
  MeshHeader told;
  told.dimension = header.dimension;
  told.has_input_index = header.has_input_index;
  told.points = header.points;
  if (header.extent && !header.extent->empty()) {
    told.extent = Extent{header.extent->lo, header.extent->hi};
  }
  told.crs = header.crs;
  told.lattice = public_lattice(header.lattice);
  told.periodic = header.periodic;
  told.attributes = header.attributes.attributes();
  return told;
}

MeshStreamHeader stream_header(const MeshHeader& header) {
  MeshStreamHeader stream;
  stream.dimension = header.dimension;
  stream.has_input_index = header.has_input_index;
  stream.points = header.points;
  stream.extent = told_box(header.extent, "a mesh");
  stream.crs = header.crs;
  stream.lattice = checked_lattice(header.lattice);
  if (header.periodic) {
    static_cast<void>(Torus(*header.periodic, std::min(header.dimension, 3)));
    stream.periodic = header.periodic;
  }
  stream.attributes = checked_attributes(header.attributes);
  return stream;
}

std::optional<Box<3>> extent_of_blocks(const MeshStreamHeader& header) {
  if (!header.extent || !header.lattice) return header.extent;
  return nearest_integers(*header.lattice, *header.extent);
}

namespace {

/// Of all corners, a number for each axis.
std::vector<std::int8_t> public_offsets(const MeshStreamBlock& block, int dimension) {
  const std::size_t axes = static_cast<std::size_t>(dimension);
  std::vector<std::int8_t> offsets((block.corners.size() - block.offsets.size()) * axes);
  for (const CornerOffset offset : block.offsets) {
    for (int k = 0; k < dimension; ++k) {
      offsets.push_back(static_cast<std::int8_t>(periods_along(offset, k)));
    }
  }
  return offsets;
}

std::vector<CornerOffset> stream_offsets(const MeshBlock& block, const MeshStreamHeader& header) {
  const std::size_t axes = static_cast<std::size_t>(header.dimension);
  if (block.offsets.size() != (header.periodic ? block.corners.size() * axes : 0)) {
    throw InvalidArgument(fmt::format("a block has {} corners, but {} offsets",
                                      block.corners.size(), block.offsets.size()));
  }
  std::vector<CornerOffset> offsets;
  for (std::size_t i = 0; i < block.offsets.size(); i += axes) {
    const std::span<const std::int8_t> periods = std::span(block.offsets).subspan(i, axes);
    for (std::size_t k = 0; k < axes; ++k) {
      const int most = header.periodic->periodic[k] ? 1 : 0;
      if (std::abs(periods[k]) > most) {
        throw InvalidArgument(fmt::format("a corner has the offset {} along {}, beyond {}",
                                          periods[k], "xyz"[k], most));
      }
    }
    offsets.push_back(corner_offset(periods));
    if (i / axes % (axes + 1) == 0 && offsets.back() != kNoOffset) {
      throw InvalidArgument("the first corner of a simplex has an offset");
    }
  }
  // Those of the first simplices, while these have none, are not told.
  const auto first =
      std::ranges::find_if(offsets, [](CornerOffset offset) { return offset != kNoOffset; });
  const auto corners = static_cast<std::ptrdiff_t>(axes) + 1;
  offsets.erase(offsets.begin(), offsets.begin() + (first - offsets.begin()) / corners * corners);
  return offsets;
}

}  // namespace

MeshBlock public_block(const MeshStreamHeader& header, MeshStreamBlock&& block,
                       std::uint64_t first_vertex) {
  MeshBlock told;
  told.first_vertex = first_vertex;
  append_stream_numbers(block, first_vertex, told.corners);
  if (header.periodic) told.offsets = public_offsets(block, header.dimension);
  told.finalized.reserve(block.finalized.size());
  const std::size_t own = block.vertices.size();
  for (const std::uint32_t vertex : block.finalized) {
    told.finalized.push_back(vertex < own ? first_vertex + vertex : block.imported[vertex - own]);
  }
  told.vertices = public_points(header.lattice, block.vertices);
  if (header.lattice) {
    told.on_lattice.reserve(own);
    for (const LatticePoint& vertex : block.vertices) told.on_lattice.push_back(vertex.numbers());
  }
  told.input_index = std::move(block.input_index);
  told.attributes = columns_of(header.attributes, block.attributes);
  return told;
}

ProgramBlocks::ProgramBlocks(const MeshHeader& header)
    : header_(stream_header(header)), told_(header_.attributes) {
  if (!is_dimension(header.dimension)) {
    throw InvalidArgument(fmt::format("a mesh has 2 to 6 dimensions, not {}", header.dimension));
  }
  if (!has_further_coordinates(header_.attributes, header.dimension)) {
    throw InvalidArgument(fmt::format(
        "the first attributes of a mesh of {0} dimensions are its coordinates beyond z: "
        "x4 to x{0}, a float64 each, without a scale",
        header.dimension));
  }
  if (header.lattice && further_axes(header.dimension) > 0) {
    throw InvalidArgument("a mesh has a lattice, but coordinates beyond z are on none");
  }
}

void ProgramBlocks::check(const MeshBlock& block) const {
  if (block.vertices.size() + block.corners.size() > std::numeric_limits<std::uint32_t>::max()) {
    throw InvalidArgument("a block of a mesh has too many vertices and corners: give smaller ones");
  }
  if (block.first_vertex != vertices_) {
    throw InvalidArgument(fmt::format("the first vertex of a block is {}, but {} have come before",
                                      block.first_vertex, vertices_));
  }
  if (block.corners.size() % static_cast<std::size_t>(header_.dimension + 1) != 0) {
    throw InvalidArgument(fmt::format("{} corners are not of simplices with {} each",
                                      block.corners.size(), header_.dimension + 1));
  }
  if (header_.has_input_index && block.input_index.size() != block.vertices.size()) {
    throw InvalidArgument(fmt::format("a block has {} vertices, but {} input indices",
                                      block.vertices.size(), block.input_index.size()));
  }
  if (!block.on_lattice.empty() &&
      (!header_.lattice || block.on_lattice.size() != block.vertices.size())) {
    throw InvalidArgument(fmt::format(
        "a block has {} vertices, but {} of them on {}", block.vertices.size(),
        block.on_lattice.size(), header_.lattice ? "the lattice" : "a lattice, which is not told"));
  }
  check_columns(block.attributes, told_, block.vertices.size(), "vertices");
  for (std::size_t v = 0; v < block.vertices.size(); ++v) {
    const spillway::Point<3>& vertex = block.vertices[v];
    if (!std::ranges::all_of(vertex, [](double x) { return std::isfinite(x); })) {
      throw InvalidArgument(
          fmt::format("vertex {} has a coordinate that is not finite", vertices_ + v));
    }
    if (header_.extent) check_inside(vertex, vertices_ + v);
  }
  const std::set<std::uint64_t> finalized(block.finalized.begin(), block.finalized.end());
  if (finalized.size() < block.finalized.size()) {
    throw InvalidArgument("a block of a mesh finalizes a vertex twice");
  }
}

/// What headers of files tell is within a step of the lattice.
void ProgramBlocks::check_inside(const spillway::Point<3>& vertex, std::uint64_t number) const {
  for (int axis = 0; axis < 3; ++axis) {
    const double step = header_.lattice ? std::abs(header_.lattice->scale[axis]) : 0;
    if (vertex[axis] >= header_.extent->lo[axis] - step &&
        vertex[axis] <= header_.extent->hi[axis] + step) {
      continue;
    }
    throw InvalidArgument(
        fmt::format("vertex {} ({}) is outside of the extent that the header tells", number,
                    fmt::join(vertex, ", ")));
  }
}

std::vector<LatticePoint> ProgramBlocks::vertices_of(const MeshBlock& block) const {
  if (!header_.lattice) return points_without_lattice(block.vertices);
  std::vector<LatticePoint> vertices;
  vertices.reserve(block.vertices.size());
  for (std::size_t v = 0; v < block.vertices.size(); ++v) {
    if (block.on_lattice.empty()) {
      vertices.push_back(found(block.vertices[v], vertices_ + v));
    } else {
      check_told(block.on_lattice[v], block.vertices[v], vertices_ + v);
      vertices.emplace_back(block.on_lattice[v]);
    }
  }
  return vertices;
}

/// In the plane z may lie between the steps.
LatticePoint ProgramBlocks::found(const spillway::Point<3>& vertex, std::uint64_t number) const {
  const IntegerLattice& lattice = *header_.lattice;
  LatticePoint place(vertex);
  for (int axis = 0; axis < 3; ++axis) {
    if (axis == 2 && header_.dimension == 2) {
      const double between = (vertex[axis] - lattice.offset[axis]) / lattice.scale[axis];
      if (const auto integer = lattice.to_integer(axis, vertex[axis])) {
        place[axis] = *integer;
        continue;
      }
      if (lattice.to_world(axis, between) == vertex[axis]) {
        place[axis] = between;
        continue;
      }
    }
    place[axis] = integer_on(lattice, axis, vertex[axis], "vertex", number);
  }
  return place;
}

/// What a program gives twice is to be the same.
void ProgramBlocks::check_told(const Point<3>& told, const spillway::Point<3>& vertex,
                               std::uint64_t number) const {
  for (int axis = 0; axis < 3; ++axis) {
    const bool whole = axis < header_.dimension;
    if (header_.lattice->to_world(axis, told[axis]) == vertex[axis] &&
        (!whole || std::trunc(told[axis]) == told[axis])) {
      continue;
    }
    throw InvalidArgument(fmt::format(
        "{} of vertex {} is {}, but {} steps of the lattice: clear on_lattice where coordinates "
        "are changed",
        "xyz"[axis], number, vertex[axis], told[axis]));
  }
}

void ProgramBlocks::check_further(const MeshStreamBlock& block) const {
  const CoordinateCheck check(header_.attributes, header_.dimension);
  const std::size_t size = header_.attributes.record_size();
  if (const auto bad = check.first_bad(block.attributes, size)) {
    throw InvalidArgument(fmt::format("vertex {} has {}", vertices_ + *bad,
                                      check.text(&block.attributes[*bad * size])));
  }
}

MeshStreamBlock ProgramBlocks::next(const MeshBlock& block) {
  check(block);
  ShortNumbers numbers(block.first_vertex, block.vertices.size());
  const std::uint64_t come = block.first_vertex + block.vertices.size();
  const auto number_of = [&](std::uint64_t vertex) {
    if (vertex < come) return numbers.of(vertex);
    throw InvalidArgument(
        fmt::format("a block of a mesh uses vertex {}, but only {} have come", vertex, come));
  };
  MeshStreamBlock stream;
  stream.vertices = vertices_of(block);
  stream.input_index = block.input_index;
  stream.attributes = records_of(block.attributes, header_.attributes, 0, block.vertices.size());
  check_further(stream);
  stream.corners.reserve(block.corners.size());
  for (const std::uint64_t vertex : block.corners) stream.corners.push_back(number_of(vertex));
  stream.offsets = stream_offsets(block, header_);
  stream.finalized.reserve(block.finalized.size());
  for (const std::uint64_t vertex : block.finalized) {
    stream.finalized.push_back(number_of(vertex));
  }
  stream.imported = numbers.take_imported();
  for (const std::uint64_t vertex : stream.imported) {
    if (imports_.import(vertex)) continue;
    throw InvalidArgument(
        fmt::format("a block of a mesh uses vertex {}, which an earlier one finalized", vertex));
  }
  imports_.settle(stream);
  vertices_ += block.vertices.size();
  simplices_ += block.corners.size() / static_cast<std::size_t>(header_.dimension + 1);
  return stream;
}

}  // namespace spillway::stream
