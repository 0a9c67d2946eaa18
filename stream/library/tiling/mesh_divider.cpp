#include "stream/library/tiling/mesh_divider.h"

#include <algorithm>
#include <array>
#include <utility>

#include "src/error.h"
#include "src/geometry/lattice.h"

namespace spillway::stream {
namespace {

constexpr std::size_t kMostCorners = 7;  // in six dimensions

/// Of one that comes for the first time.
std::optional<std::uint64_t> index_of(const MeshStreamBlock& block, std::uint32_t vertex) {
  if (block.input_index.empty()) return {};
  return block.input_index[vertex];
}

}  // namespace

MeshDivider::MeshDivider(const MeshStreamHeader& header, MeshTiling& tiling, RecordsByTile& records)
    : header_(header), tiling_(tiling), records_(records) {}

/// In output coordinates. Of sorted numbers, so that it does not depend on the order of corners.
Point<2> MeshDivider::centroid(std::span<const std::uint32_t> corners) {
  const double share = 1 / static_cast<double>(corners.size());
  Point<2> centroid{};
  for (int k = 0; k < 2; ++k) {
    coordinates_.clear();
    for (const std::uint32_t v : corners) {
      coordinates_.push_back(points_[v][k]);
    }
    std::ranges::sort(coordinates_);
    // Shares before the sum, which might be too large for a number.
    for (const double coordinate : coordinates_) centroid[k] += coordinate * share;
  }
  return centroid;
}

template <typename Put>
void MeshDivider::add_record(std::size_t tile, const Put& put) {
  record_.clear();
  put(record_);
  records_.add(tile, record_.bytes());
}

void MeshDivider::add_place(std::uint32_t vertex, const Place& place) {
  links_.push_back({place, heads_[vertex]});
  heads_[vertex] = static_cast<std::uint32_t>(links_.size() - 1);
}

/// Looks up what is known of a block's vertices.
void MeshDivider::enter(const MeshStreamBlock& block) {
  points_.clear();
  earlier_.clear();
  links_.clear();
  heads_.assign(block.vertices.size() + block.imported.size(), kNone);
  const auto add_point = [&](const LatticePoint& vertex) {
    const WorldPoint point = in_world(header_.lattice, vertex);
    points_.push_back({point[0], point[1]});
  };
  for (const LatticePoint& vertex : block.vertices) add_point(vertex);
  for (const std::uint64_t number : block.imported) {
    const Vertex& vertex = live_.at(number);
    for (const Place& place : vertex.places) {
      add_place(static_cast<std::uint32_t>(points_.size()), place);
    }
    add_point(vertex.point);
    earlier_.push_back(&vertex);
  }
}

std::uint32_t MeshDivider::number_in(std::size_t tile, std::uint32_t vertex,
                                     const MeshStreamBlock& block) {
  for (std::uint32_t at = heads_[vertex]; at != kNone; at = links_[at].next) {
    if (links_[at].place.tile == tile) return links_[at].place.number;
  }
  if (heads_[vertex] == kNone) ++placed_;
  const std::uint32_t number = counts_[tile].vertices++;
  if (number == kNone) {
    throw Failure("a tile would have more than 4294967295 vertices: choose smaller tiles",
                  ErrorCode::kTooLarge);
  }
  const std::size_t fresh = block.vertices.size();
  if (vertex >= fresh) {
    const Vertex& known = *earlier_[vertex - fresh];
    add_record(tile, [&](Packer& record) {
      put_vertex(record, known.point, known.input_index, known.attributes);
    });
  } else {
    const std::size_t size = header_.attributes.record_size();
    add_record(tile, [&](Packer& record) {
      put_vertex(record, block.vertices[vertex], index_of(block, vertex),
                 std::span(block.attributes).subspan(vertex * size, size));
    });
  }
  add_place(vertex, {tile, number});
  return number;
}

void MeshDivider::put_simplex(std::size_t tile, std::span<const std::uint32_t> corners,
                              const MeshStreamBlock& block) {
  if (counts_.size() <= tile) counts_.resize(tile + 1);
  ++counts_[tile].simplices;
  std::array<std::uint32_t, kMostCorners> numbers{};
  for (std::size_t i = 0; i < corners.size(); ++i) {
    numbers[i] = number_in(tile, corners[i], block);
  }
  add_record(tile, [&](Packer& record) {
    stream::put_simplex(record, std::span(numbers).first(corners.size()));
  });
}

/// Keeps what is to come again.
void MeshDivider::leave(const MeshStreamBlock& block) {
  const auto places_of = [&](std::uint32_t v) {
    std::vector<Place> places;
    for (std::uint32_t at = heads_[v]; at != kNone; at = links_[at].next) {
      places.push_back(links_[at].place);
    }
    return places;
  };
  for (const std::uint32_t v : block.finalized) {
    for (const Place& place : places_of(v)) {
      add_record(place.tile, [&](Packer& record) { put_finalized(record, place.number); });
    }
  }
  const auto fresh = static_cast<std::uint32_t>(block.vertices.size());
  for (std::uint32_t i = 0; i < block.imported.size(); ++i) {
    live_.find(block.imported[i])->places = places_of(fresh + i);
  }
  live_.settle(block, [&](std::uint32_t v) {
    Vertex vertex{
        .point = block.vertices[v], .input_index = index_of(block, v), .places = places_of(v)};
    const std::size_t size = header_.attributes.record_size();
    const auto record = std::span(block.attributes).subspan(v * size, size);
    vertex.attributes.assign(record.begin(), record.end());
    return vertex;
  });
}

void MeshDivider::write(MeshStreamBlock&& block) {
  enter(block);
  const auto corners = static_cast<std::size_t>(header_.dimension) + 1;
  for (std::size_t c = 0; c < block.corners.size(); c += corners) {
    const auto simplex = std::span<const std::uint32_t>(block.corners).subspan(c, corners);
    tiling_.find(centroid(simplex), tiles_);
    if (tiles_.empty()) ++outside_;
    for (const std::size_t tile : tiles_) put_simplex(tile, simplex, block);
  }
  leave(block);
}

void MeshDivider::finish(const MeshTotals& /*totals*/) {}

}  // namespace spillway::stream
