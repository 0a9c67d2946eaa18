#include "stream/checker/needed_vertices.h"

#include <fmt/format.h>

#include <limits>

#include "src/error.h"
#include "src/geometry/dimensions.h"

namespace spillway::checker {

template <int D>
void NeededVertices<D>::enter(const MeshStreamBlock& block, std::vector<Point<D>>& points,
                              std::vector<std::uint32_t>& slots) {
  slots.clear();
  for (std::size_t v = 0; v < points.size(); ++v) {
    slots.push_back(add(points[v], importable_.announced() + v));
  }
  for (const std::uint64_t number : block.imported) {
    const std::uint32_t* const slot = importable_.find(number);
    if (slot == nullptr) {
      throw Failure(
          fmt::format("the mesh stream uses vertex {}, which has not come yet or is finalized; "
                      "write the file again",
                      number),
          ErrorCode::kBadInput, {.place = at_record(number)});
    }
    slots.push_back(*slot);
    points.push_back(vertices_[*slot].point);
  }
  importable_.settle(block, slots);
}

template <int D>
std::uint32_t NeededVertices<D>::add(const Point<D>& point, std::uint64_t number) {
  if (free_.empty()) {
    if (vertices_.size() > std::numeric_limits<std::uint32_t>::max()) {
      throw Failure(fmt::format("the mesh stream has {} vertices open at a time, too many to check",
                                vertices_.size()),
                    ErrorCode::kTooLarge);
    }
    free_.push_back(static_cast<std::uint32_t>(vertices_.size()));
    vertices_.emplace_back();
  }
  const std::uint32_t slot = free_.back();
  free_.pop_back();
  vertices_[slot] = {.point = point, .number = number, .holders = 0};
  return slot;
}

template <int D>
void NeededVertices<D>::finalize(std::uint32_t slot) {
  Vertex& vertex = vertices_[slot];
  if (vertex.finalized) {
    throw Failure(fmt::format("the mesh stream finalizes vertex {} twice; write the file again",
                              vertex.number),
                  ErrorCode::kBadInput, {.place = at_record(vertex.number)});
  }
  vertex.finalized = true;
  if (vertex.holders == 0) free_.push_back(slot);
}

#define SPILLWAY_INSTANTIATE(D) template class NeededVertices<D>;
SPILLWAY_FOR_EACH_DIMENSION(SPILLWAY_INSTANTIATE)
#undef SPILLWAY_INSTANTIATE

}  // namespace spillway::checker
