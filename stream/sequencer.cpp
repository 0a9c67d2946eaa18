#include "stream/sequencer.h"

#include <utility>

namespace spillway {

template <int D>
Sequencer<D>::Sequencer(MeshStreamWriter& writer, const OutputOptions& output, StageTimes& times)
    : writer_(writer), times_(times), counts_facets_(output.max_edge.has_value()) {}

template <int D>
void Sequencer<D>::submit(std::uint32_t block, MeshBlock mesh, std::vector<StreamPlace> imported,
                          const CanonicalHash<D>& hash) {
  const std::uint64_t vertices = mesh.vertices.size();
  const std::uint64_t simplices = mesh.corners.size() / (D + 1);
  Waiting waiting{std::move(mesh), std::move(imported), vertices, simplices};
  if (!counts_facets_) {
    const StageTimer timer(times_, Stage::kEncode);
    writer_.prepare(waiting.mesh);
  }
  const std::lock_guard lock(mutex_);
  hash_.add(hash);
  waiting_.emplace(block, std::move(waiting));
  for (auto next = waiting_.begin(); next != waiting_.end() && next->first == first_vertex_.size();
       next = waiting_.begin()) {
    Waiting turn = std::move(next->second);
    waiting_.erase(next);
    write(std::move(turn));
  }
}

template <int D>
void Sequencer<D>::write(Waiting&& waiting) {
  const StageTimer timer(times_, Stage::kWrite);
  first_vertex_.push_back(vertices_);
  MeshBlock& mesh = waiting.mesh;
  mesh.imported.reserve(waiting.imported.size());
  for (const StreamPlace& place : waiting.imported) {
    mesh.imported.push_back(first_vertex_[place.block] + place.vertex);
  }
  if (counts_facets_) {
    for (std::size_t i = 0; i < mesh.corners.size(); i += D + 1) {
      std::array<std::uint64_t, D + 1> corners;
      for (int k = 0; k <= D; ++k) {
        const std::uint32_t v = mesh.corners[i + k];
        corners[k] = v < waiting.vertices ? vertices_ + v : mesh.imported[v - waiting.vertices];
      }
      open_facets_.add(corners);
    }
  }
  vertices_ += waiting.vertices;
  simplices_ += waiting.simplices;
  const bool empty = waiting.vertices == 0 && waiting.simplices == 0 && mesh.imported.empty();
  if (!empty) writer_.write(std::move(mesh));
}

template <int D>
MeshTotals Sequencer<D>::totals() const {
  const std::lock_guard lock(mutex_);
  MeshTotals totals;
  totals.vertices = vertices_;
  totals.simplices = simplices_;
  totals.hull_facets = open_facets_.count();
  totals.canonical_hash = hash_.value();
  return totals;
}

template class Sequencer<2>;
template class Sequencer<3>;

}  // namespace spillway
