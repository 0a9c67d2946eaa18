#include "stream/sinks/tetrahedron_writers.h"

#include <algorithm>
#include <cmath>
#include <unordered_set>

#include "formats/meshes/common/stream_numbers.h"
#include "src/geometry/longest_edge.h"

namespace spillway::stream {
namespace {

Point<3> difference(const Point<3>& a, const Point<3>& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}

double volume(const std::array<Point<3>, 4>& corners) {
  const Point<3> a = difference(corners[1], corners[0]);
  const Point<3> b = difference(corners[2], corners[0]);
  const Point<3> c = difference(corners[3], corners[0]);
  return std::abs(a[0] * (b[1] * c[2] - b[2] * c[1]) - a[1] * (b[0] * c[2] - b[2] * c[0]) +
                  a[2] * (b[0] * c[1] - b[1] * c[0])) /
         6;
}

}  // namespace

void TetrahedronWriter::write(MeshStreamBlock&& block) {
  const StreamNumbers numbers(live_.announced(), block);
  std::vector<WorldPoint> vertices;
  for (const LatticePoint& vertex : block.vertices) {
    vertices.push_back(in_world(lattice_, vertex));
    extent_.expand(vertices.back());
  }
  live_.append_imported(block, vertices);
  for (std::size_t c = 0; c < block.corners.size(); c += 4) {
    std::array<std::uint64_t, 4> of{};
    Corners corners{};
    for (std::size_t i = 0; i < 4; ++i) {
      of[i] = numbers[block.corners[c + i]];
      corners[i] = vertices[block.corners[c + i]];
    }
    if (max_edge_ && has_longer_edge<3>(corners, *max_edge_)) {
      ++left_out_;
    } else {
      add(of, corners);
    }
  }
  live_.settle(block, vertices);
  for (const std::uint32_t v : block.finalized) retire(numbers[v], vertices[v]);
}

void TetrahedronWriter::finish(const MeshTotals& /*totals*/) {
  live_.for_each(
      [this](std::uint64_t number, const WorldPoint& vertex) { retire(number, vertex); });
  live_ = {};
}

void HullWriter::add(const std::array<std::uint64_t, 4>& numbers,
                     const std::array<Point<3>, 4>& /*corners*/) {
  open_.add(numbers);
}

void HullWriter::retire(std::uint64_t number, const WorldPoint& vertex) {
  retired_.emplace(number, vertex);
  if (retired_.size() > std::max<std::size_t>(most_retired_, open_.count())) {
    forget_inner_vertices();
    most_retired_ = std::max(most_retired_, 2 * retired_.size());
  }
}

void HullWriter::forget_inner_vertices() {
  std::unordered_set<std::uint64_t> outer;
  for (const auto& facet : open_) outer.insert(facet.begin(), facet.end());
  std::erase_if(retired_, [&outer](const auto& vertex) { return !outer.contains(vertex.first); });
}

std::vector<std::array<Point<3>, 3>> HullWriter::facets() const {
  std::vector<std::array<Point<3>, 3>> facets;
  facets.reserve(open_.count());
  for (const auto& facet : open_) {
    facets.push_back({retired_.at(facet[0]), retired_.at(facet[1]), retired_.at(facet[2])});
  }
  return facets;
}

void SliceWriter::add(const std::array<std::uint64_t, 4>& /*numbers*/,
                      const std::array<Point<3>, 4>& corners) {
  const PlaneCut found = cut(corners, plane_);
  if (found.count > 0) cuts_.push_back({found, static_cast<float>(std::cbrt(volume(corners)))});
}

}  // namespace spillway::stream
