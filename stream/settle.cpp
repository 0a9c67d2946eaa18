#include "stream/settle.h"

#include <algorithm>

#include "src/geometry/longest_edge.h"

namespace spillway {
namespace {

// What a vertex is used by, as bits.
constexpr std::uint8_t kByFinal = 1;
constexpr std::uint8_t kByBorder = 2;
constexpr std::uint8_t kByEmitted = 4;  ///< a final one that is not left out

template <int D>
class Settlement {
  using Corners = std::array<VertexId, D + 1>;

 public:
  Settlement(const SettleInput<D>& input, const OutputOptions& output)
      : input_(input), output_(output) {}

  Settled<D> run() {
    map_vertices();
    mark_uses();
    number_vertices();
    for (std::size_t s = 0; s < input_.simplices.size(); ++s) {
      if (input_.is_final[s] != 0) {
        emit(input_.simplices[s]);
      } else {
        keep(input_.simplices[s]);
      }
    }
    return std::move(result_);
  }

 private:
  void map_vertices() {
    world_.resize(input_.vertices.size());
    for (std::size_t v = 0; v < world_.size(); ++v) {
      world_[v] = input_.vertices[v].position;
      if (!output_.lattice) continue;
      for (int k = 0; k < D; ++k) world_[v][k] = output_.lattice->to_world(k, world_[v][k]);
    }
  }

  /// Too long simplices count as uses: their vertices belong to the mesh.
  void mark_uses() {
    use_.resize(input_.vertices.size());
    for (std::size_t s = 0; s < input_.simplices.size(); ++s) {
      std::uint8_t use = kByBorder;
      if (input_.is_final[s] != 0) {
        use = is_left_out(input_.simplices[s]) ? kByFinal : kByFinal | kByEmitted;
      }
      for (const VertexId v : input_.simplices[s]) {
        if (v != kInfiniteVertex) use_[v] |= use;
      }
    }
  }

  void number_vertices() {
    MeshBlock& mesh = result_.mesh;
    result_.border.dimension = input_.dimension;
    const std::size_t count = input_.vertices.size();
    short_number_.resize(count);
    kept_number_.resize(count);
    for (VertexId v = 0; v < count; ++v) {
      const BorderVertex<D>& vertex = input_.vertices[v];
      if (vertex.place.announced() || (use_[v] & kByFinal) == 0) continue;
      short_number_[v] = static_cast<std::uint32_t>(mesh.vertices.size());
      mesh.vertices.push_back(output_point(vertex));
      if (output_.input_index) mesh.input_index.push_back(vertex.input_index);
    }
    auto next = static_cast<std::uint32_t>(mesh.vertices.size());
    for (VertexId v = 0; v < count; ++v) {
      const BorderVertex<D>& vertex = input_.vertices[v];
      const bool kept = (use_[v] & kByBorder) != 0;
      if (vertex.place.announced() && ((use_[v] & kByEmitted) != 0 || !kept)) {
        short_number_[v] = next++;
        result_.imported.push_back(vertex.place);
      }
      if (!kept) {
        if (use_[v] != 0 || vertex.place.announced()) mesh.finalized.push_back(short_number_[v]);
        continue;
      }
      kept_number_[v] = static_cast<VertexId>(result_.border.vertices.size());
      result_.border.vertices.push_back(vertex);
      if (!vertex.place.announced() && (use_[v] & kByFinal) != 0) {
        result_.border.vertices.back().place = {input_.block, short_number_[v]};
      }
    }
  }

  [[nodiscard]] static Point<3> output_point(const BorderVertex<D>& vertex) {
    if constexpr (D == 2) {
      return {vertex.position[0], vertex.position[1], vertex.height};
    } else {
      return vertex.position;
    }
  }

  [[nodiscard]] std::array<Point<D>, D + 1> positions(const Corners& corners) const {
    std::array<Point<D>, D + 1> world;
    for (int i = 0; i <= D; ++i) world[i] = world_[corners[i]];
    return world;
  }

  /// Whether a final simplex has too long an edge.
  [[nodiscard]] bool is_left_out(const Corners& corners) const {
    if (!output_.max_edge) return false;
    const bool infinite =
        std::find(corners.begin(), corners.end(), kInfiniteVertex) != corners.end();
    return !infinite && has_longer_edge<D>(positions(corners), *output_.max_edge);
  }

  void emit(const Corners& corners) {
    ++result_.final_simplices;
    if (std::find(corners.begin(), corners.end(), kInfiniteVertex) != corners.end()) {
      ++result_.hull_facets;
      return;
    }
    if (is_left_out(corners)) {
      ++result_.left_out;
      return;
    }
    result_.hash.add(positions(corners));
    for (const VertexId v : corners) result_.mesh.corners.push_back(short_number_[v]);
  }

  void keep(Corners corners) {
    for (VertexId& v : corners) {
      if (v != kInfiniteVertex) v = kept_number_[v];
    }
    result_.border.simplices.push_back(corners);
  }

  const SettleInput<D>& input_;
  const OutputOptions& output_;
  std::vector<Point<D>> world_;              // by vertex, in output coordinates
  std::vector<std::uint8_t> use_;            // by vertex
  std::vector<std::uint32_t> short_number_;  // by vertex: in the mesh block
  std::vector<VertexId> kept_number_;        // by vertex: in the border
  Settled<D> result_;
};

}  // namespace

template <int D>
Settled<D> settle(const SettleInput<D>& input, const OutputOptions& output) {
  return Settlement<D>(input, output).run();
}

template Settled<2> settle<2>(const SettleInput<2>&, const OutputOptions&);
template Settled<3> settle<3>(const SettleInput<3>&, const OutputOptions&);

}  // namespace spillway
