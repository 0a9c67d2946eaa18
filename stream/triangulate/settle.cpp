#include "stream/triangulate/settle.h"

#include <memory>

#include "src/geometry/longest_edge.h"

namespace spillway::detail {
namespace {

// What a vertex is used by, as bits.
constexpr std::uint8_t kByFinal = 1;
constexpr std::uint8_t kByBorder = 2;
constexpr std::uint8_t kByEmitted = 4;  ///< a final one that is not left out

/// Memory is fetched this many vertices ahead.
constexpr VertexId kAhead = 16;

template <int D, typename Part>
class Settlement {
  using Corners = std::array<VertexId, D + 1>;

 public:
  Settlement(const Part& part, const OutputOptions& output)
      : part_(part),
        output_(output),
        use_(part.vertex_count()),
        short_number_(std::make_unique_for_overwrite<std::uint32_t[]>(use_.size())),
        kept_number_(std::make_unique_for_overwrite<VertexId[]>(use_.size())) {}

  Settled<D> run() {
    mark_uses();
    announce_vertices();
    import_and_finalize();
    list_simplices();
    result_.hash.add(result_.mesh.corners, hashes_);
    return std::move(result_);
  }

 private:
  /// Too long simplices count as uses: their vertices belong to the mesh. Infinite ones that are
  /// final do not: nothing of them is in the mesh, and each of their vertices has finite ones.
  void mark_uses() {
    for (std::size_t s = 0; s < part_.simplex_count(); ++s) {
      if (part_.fates[s] == Fate::kFinal) {
        const Corners corners = part_.finite_simplex(s);
        const std::uint8_t use = is_left_out(corners) ? kByFinal : kByFinal | kByEmitted;
        for (const VertexId v : corners) use_[v] |= use;
      } else if (part_.fates[s] == Fate::kKept) {
        ++kept_;
        for (const VertexId v : part_.simplex(s)) {
          if (v != kInfiniteVertex) use_[v] |= kByBorder;
        }
      }
    }
  }

  void announce_vertices() {
    MeshBlock& mesh = result_.mesh;
    mesh.vertices.reserve(use_.size());
    hashes_.reserve(use_.size());
    if (output_.input_index) mesh.input_index.reserve(use_.size());
    for (VertexId v = 0; v < use_.size(); ++v) {
      part_.expect(v + kAhead);
      if ((use_[v] & kByFinal) == 0 || part_.place(v).announced()) continue;
      const BorderVertex<D>& vertex = part_.vertex(v);
      short_number_[v] = static_cast<std::uint32_t>(mesh.vertices.size());
      mesh.vertices.push_back(output_point(vertex));
      if (output_.input_index) mesh.input_index.push_back(vertex.input_index);
      hashes_.push_back(vertex_hash<D>(world(vertex.position)));
    }
  }

  void import_and_finalize() {
    MeshBlock& mesh = result_.mesh;
    result_.border.dimension = part_.dimension();
    mesh.finalized.reserve(mesh.vertices.size());
    for (VertexId v = 0; v < use_.size(); ++v) {
      const StreamPlace place = part_.place(v);
      const bool kept = (use_[v] & kByBorder) != 0;
      if (place.announced() && ((use_[v] & kByEmitted) != 0 || !kept)) import(v);
      if (!kept) {
        if (use_[v] != 0 || place.announced()) mesh.finalized.push_back(short_number_[v]);
        continue;
      }
      kept_number_[v] = static_cast<VertexId>(result_.border.vertices.size());
      result_.border.vertices.push_back(part_.vertex(v));
      if (!place.announced() && (use_[v] & kByFinal) != 0) {
        result_.border.vertices.back().place = {part_.block, short_number_[v]};
      }
    }
  }

  void import(VertexId v) {
    const BorderVertex<D>& vertex = part_.vertex(v);
    short_number_[v] = static_cast<std::uint32_t>(hashes_.size());
    hashes_.push_back(vertex_hash<D>(world(vertex.position)));
    result_.imported.push_back(vertex.place);
    if (!output_.imported_vertices) return;
    result_.imported_vertices.push_back(output_point(vertex));
    if (output_.input_index) result_.imported_index.push_back(vertex.input_index);
  }

  void list_simplices() {
    const std::size_t count = part_.simplex_count();
    result_.final_simplices = count - kept_;
    result_.border.simplices.reserve(kept_);
    result_.mesh.corners.resize((D + 1) * (count - kept_));
    std::uint32_t* end = result_.mesh.corners.data();
    for (std::size_t s = 0; s < count; ++s) {
      if (part_.fates[s] == Fate::kFinal) {
        const Corners corners = part_.finite_simplex(s);
        if (is_left_out(corners)) {
          ++result_.left_out;
        } else {
          for (const VertexId v : corners) *end++ = short_number_[v];
        }
      } else if (part_.fates[s] == Fate::kKept) {
        keep(part_.simplex(s));
      } else {
        ++result_.hull_facets;
      }
    }
    result_.mesh.corners.resize(static_cast<std::size_t>(end - result_.mesh.corners.data()));
  }

  void keep(Corners corners) {
    for (VertexId& v : corners) {
      if (v != kInfiniteVertex) v = kept_number_[v];
    }
    result_.border.simplices.push_back(corners);
  }

  [[nodiscard]] static LatticePoint output_point(const BorderVertex<D>& vertex) {
    if constexpr (D == 2) {
      return {vertex.position[0], vertex.position[1], vertex.height};
    } else {
      return LatticePoint(vertex.position);
    }
  }

  /// In output coordinates.
  [[nodiscard]] Point<D> world(Point<D> position) const {
    if (!output_.lattice) return position;
    for (int k = 0; k < D; ++k) position[k] = output_.lattice->to_world(k, position[k]);
    return position;
  }

  /// Whether a finite simplex has too long an edge.
  [[nodiscard]] bool is_left_out(const Corners& corners) const {
    if (!output_.max_edge) return false;
    std::array<Point<D>, D + 1> positions;
    for (int i = 0; i <= D; ++i) positions[i] = world(part_.position(corners[i]));
    return has_longer_edge<D>(positions, *output_.max_edge);
  }

  const Part& part_;
  const OutputOptions& output_;
  std::vector<std::uint8_t> use_;                  // by vertex
  std::unique_ptr<std::uint32_t[]> short_number_;  // by vertex, if it is in the mesh block
  std::unique_ptr<VertexId[]> kept_number_;        // by vertex, if it is in the border
  std::vector<std::uint64_t> hashes_;              // by short number
  std::size_t kept_ = 0;                           // simplices
  Settled<D> result_;
};

}  // namespace

template <int D, template <int> typename Part>
Settled<D> settle(const Part<D>& part, const OutputOptions& output) {
  return Settlement<D, Part<D>>(part, output).run();
}

template Settled<2> settle(const MergeToSettle<2>&, const OutputOptions&);
template Settled<3> settle(const MergeToSettle<3>&, const OutputOptions&);
template Settled<2> settle(const LeafToSettle<2>&, const OutputOptions&);
template Settled<3> settle(const LeafToSettle<3>&, const OutputOptions&);

}  // namespace spillway::detail
