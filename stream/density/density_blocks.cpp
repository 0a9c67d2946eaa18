#include "stream/density/density_blocks.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <type_traits>
#include <utility>

#include "src/error.h"
#include "src/geometry/determinants.h"
#include "stream/library/points/attribute_records.h"

namespace spillway::stream {
namespace {

constexpr std::uint64_t kLeaseStep = std::uint64_t{1} << 20;

}  // namespace

MeshStreamHeader with_density(MeshStreamHeader header) {
  header.attributes = AttributeLayout(
      {Attribute{.name = kDensity, .type = NumberType::kFloat64, .description = "mass by volume"}});
  return header;
}

DensityBlocks::DensityBlocks(BlockSink& sink, MeshStreamHeader header, std::string weight,
                             MemoryBudget& budget)
    : sink_(sink),
      header_(std::move(header)),
      weight_(std::move(weight)),
      corners_(static_cast<std::size_t>(header_.dimension) + 1),
      memory_(budget) {
  totals_.least = std::numeric_limits<double>::infinity();
}

void DensityBlocks::write(MeshStreamBlock&& block) {
  take_vertices(block);
  take_volumes(block);
  Made made;
  // First all that leave, so that simplices between them need not wait.
  std::vector<std::uint32_t> leaving;
  leaving.reserve(block.finalized.size());
  for (const std::uint32_t v : block.finalized) {
    leaving.push_back(places_[v]);
    let_go(places_[v], made);
  }
  for_each_simplex(block, header_.dimension, [&](SimplexCorners corners, const auto& offsets) {
    bool all_left = true;
    for (std::size_t i = 0; i < corners_; ++i) {
      corners[i] = places_[corners[i]];
      all_left &= vertices_[corners[i]].has_left;
    }
    if (all_left) {
      add_simplex(corners, offsets, made);
    } else {
      wait(corners, offsets);
    }
  });
  for (const std::uint32_t vertex : leaving) release_waiting(vertex, made);
  for (const std::uint32_t vertex : leaving) forget_if_done(vertex, made);
  live_.settle(block, places_);
  pass_on(made);
  const std::uint64_t bytes =
      vertices_.capacity() * (sizeof(Vertex) + 24) + waiting_.capacity() * sizeof(Waiting);
  if (bytes > leased_) {
    memory_.take(bytes - leased_ + kLeaseStep, "the simplices that wait for densities");
    leased_ = bytes + kLeaseStep;
  }
}

void DensityBlocks::take_vertices(const MeshStreamBlock& block) {
  const std::size_t own = block.vertices.size();
  std::vector<double> masses;
  if (!weight_.empty()) {
    masses = columns_of(header_.attributes, block.attributes).meant(weight_);
  }
  places_.clear();
  for (std::size_t v = 0; v < own; ++v) {
    Vertex vertex;
    vertex.point = block.vertices[v];
    vertex.mass = weight_.empty() ? 1 : masses[v];
    if (!(vertex.mass >= 0) || !std::isfinite(vertex.mass)) {
      const WorldPoint place = in_world(header_.lattice, vertex.point);
      throw Failure(fmt::format("the point at ({}, {}, {}) has the {} {}, which is no mass: masses "
                                "are 0 or more",
                                place[0], place[1], place[2], weight_, vertex.mass),
                    ErrorCode::kBadInput);
    }
    if (header_.has_input_index) vertex.input_index = block.input_index[v];
    places_.push_back(enter(vertex));
    extent_.expand(in_world(header_.lattice, vertex.point).numbers());
  }
  live_.append_imported(block, places_);
}

std::uint32_t DensityBlocks::enter(const Vertex& vertex) {
  if (free_vertices_.empty()) {
    vertices_.push_back(vertex);
    return static_cast<std::uint32_t>(vertices_.size() - 1);
  }
  const std::uint32_t place = free_vertices_.back();
  free_vertices_.pop_back();
  vertices_[place] = vertex;
  return place;
}

void DensityBlocks::take_volumes(const MeshStreamBlock& block) {
  for_each_simplex(block, header_.dimension, [&](SimplexCorners corners, const auto& offsets) {
    for (std::size_t i = 0; i < corners_; ++i) corners[i] = places_[corners[i]];
    const double volume = volume_of(corners, offsets);
    totals_.volume += volume;
    for (std::size_t i = 0; i < corners_; ++i) vertices_[corners[i]].volume += volume;
  });
}

double DensityBlocks::volume_of(const SimplexCorners& vertices,
                                const SimplexOffsets& offsets) const {
  std::array<WorldPoint, 4> places;
  for (std::size_t i = 0; i < corners_; ++i) {
    const WorldPoint vertex = in_world(header_.lattice, vertices_[vertices[i]].point);
    places[i] = place_of_copy(header_, vertex, offsets[i]);
  }
  const auto times_volume = [&places](auto d) {
    Vectors<d, d, double> edges;
    for (int i = 0; i < d; ++i) {
      for (int k = 0; k < d; ++k) edges[i][k] = places[i + 1][k] - places[0][k];
    }
    return std::abs(orientation_determinant<d>(edges));
  };
  return header_.dimension == 2 ? times_volume(std::integral_constant<int, 2>()) / 2
                                : times_volume(std::integral_constant<int, 3>()) / 6;
}

/// Adds a vertex whose simplices have all come to the new mesh.
void DensityBlocks::let_go(std::uint32_t place, Made& made) {
  Vertex& vertex = vertices_[place];
  if (vertex.has_left) return;
  const double density =
      vertex.volume > 0 ? static_cast<double>(corners_) * vertex.mass / vertex.volume : 0;
  vertex.has_left = true;
  vertex.number = left_++;
  made.block.vertices.push_back(vertex.point);
  if (header_.has_input_index) made.block.input_index.push_back(vertex.input_index);
  std::array<std::byte, sizeof density> bytes;
  std::memcpy(bytes.data(), &density, sizeof density);
  made.block.attributes.insert(made.block.attributes.end(), bytes.begin(), bytes.end());
  totals_.mass += density * vertex.volume / static_cast<double>(corners_);
  totals_.least = std::min(totals_.least, density);
  totals_.most = std::max(totals_.most, density);
}

void DensityBlocks::wait(const SimplexCorners& vertices, const SimplexOffsets& offsets) {
  Waiting simplex{vertices, offsets, {kNone, kNone, kNone, kNone}, 0};
  std::uint32_t place = static_cast<std::uint32_t>(waiting_.size());
  if (free_waiting_.empty()) {
    waiting_.emplace_back();
  } else {
    place = free_waiting_.back();
    free_waiting_.pop_back();
  }
  for (std::size_t i = 0; i < corners_; ++i) {
    Vertex& vertex = vertices_[vertices[i]];
    ++vertex.waiting;
    if (vertex.has_left) continue;
    ++simplex.missing;
    simplex.links[i] = vertex.first_link;
    vertex.first_link = place * 4 + static_cast<std::uint32_t>(i);
  }
  waiting_[place] = simplex;
}

/// Lets go the simplices that have waited for this vertex last.
void DensityBlocks::release_waiting(std::uint32_t place, Made& made) {
  std::uint32_t link = std::exchange(vertices_[place].first_link, kNone);
  while (link != kNone) {
    const std::uint32_t number = link / 4;
    Waiting& simplex = waiting_[number];
    link = simplex.links[link % 4];
    if (--simplex.missing > 0) continue;
    add_simplex(simplex.vertices, simplex.offsets, made);
    for (std::size_t i = 0; i < corners_; ++i) {
      --vertices_[simplex.vertices[i]].waiting;
      forget_if_done(simplex.vertices[i], made);
    }
    free_waiting_.push_back(number);
  }
}

void DensityBlocks::forget_if_done(std::uint32_t place, Made& made) {
  Vertex& vertex = vertices_[place];
  if (!vertex.has_left || vertex.waiting > 0 || vertex.is_forgotten) return;
  made.block.finalized.push_back(short_number(place, made));
  vertex.is_forgotten = true;
  free_vertices_.push_back(place);
}

/// In the block that is being made.
std::uint32_t DensityBlocks::short_number(std::uint32_t place, Made& made) const {
  const std::uint64_t number = vertices_[place].number;
  const std::uint64_t first = left_ - made.block.vertices.size();
  if (number >= first) return static_cast<std::uint32_t>(number - first);
  if (const std::uint32_t* const known = made.imports.find(number)) return *known;
  const auto imported =
      static_cast<std::uint32_t>(made.block.vertices.size() + made.block.imported.size());
  made.block.imported.push_back(number);
  made.imports.enter(number, imported);
  return imported;
}

void DensityBlocks::add_simplex(const SimplexCorners& vertices, const SimplexOffsets& offsets,
                                Made& made) {
  const bool is_across = std::any_of(offsets.begin(), offsets.end(),
                                     [](CornerOffset offset) { return offset != kNoOffset; });
  std::vector<std::uint32_t>& corners = is_across ? made.across : made.block.corners;
  for (std::size_t i = 0; i < corners_; ++i) {
    corners.push_back(short_number(vertices[i], made));
    if (is_across) made.block.offsets.push_back(offsets[i]);
  }
}

void DensityBlocks::pass_on(Made& made) {
  MeshStreamBlock& block = made.block;
  block.corners.insert(block.corners.end(), made.across.begin(), made.across.end());
  if (block.vertices.empty() && block.corners.empty() && block.finalized.empty()) return;
  sink_.write(std::move(block));
}

void DensityBlocks::finish(const MeshTotals& /*totals*/) {
  std::vector<std::uint32_t> rest;
  live_.for_each([&rest](std::uint64_t, std::uint32_t place) { rest.push_back(place); });
  std::sort(rest.begin(), rest.end());
  Made made;
  for (const std::uint32_t place : rest) let_go(place, made);
  for (const std::uint32_t place : rest) release_waiting(place, made);
  for (const std::uint32_t place : rest) forget_if_done(place, made);
  pass_on(made);
}

}  // namespace spillway::stream
