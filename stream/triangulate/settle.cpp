#include "stream/triangulate/settle.h"

#include <algorithm>
#include <functional>
#include <memory>
#include <optional>
#include <type_traits>

#include "src/geometry/dimensions.h"
#include "src/geometry/longest_edge.h"
#include "stream/periodic/chosen_simplices.h"

namespace spillway::stream {
namespace {

// What a vertex is used by, as bits.
constexpr std::uint8_t kByFinal = 1;
constexpr std::uint8_t kByBorder = 2;
constexpr std::uint8_t kByEmitted = 4;  ///< a final one that is not left out

/// Simplices that are listed before they are appended to the block.
constexpr std::size_t kListed = 64;

/// More dimensions have no periodic domain.
constexpr int kMostPeriodic = 3;

/// Memory is fetched this many vertices ahead.
constexpr VertexId kAhead = 16;

template <int D, typename Part>
class Settlement {
  using Corners = std::array<VertexId, D + 1>;
  static constexpr bool kOfLeaf = std::is_same_v<Part, LeafToSettle<D>>;

 public:
  Settlement(const Part& part, const OutputOptions& output)
      : part_(part),
        output_(output),
        use_(part.vertex_count()),
        short_number_(std::make_unique_for_overwrite<std::uint32_t[]>(use_.size())),
        kept_number_(std::make_unique_for_overwrite<VertexId[]>(use_.size())) {
    if constexpr (D <= kMostPeriodic) {
      if (output.periodic != nullptr) chosen_.emplace(*output.periodic, positions());
    }
  }

  Settled<D> run() {
    mark_uses();
    announce_vertices();
    import_and_finalize();
    list_simplices();
    return std::move(result_);
  }

 private:
  void mark_uses() {
    if constexpr (kOfLeaf) {
      const bool knows_neighbours = part_.open_simplices.size() == part_.open.size();
      if (knows_neighbours && !output_.max_edge) return mark_uses_from_border();
    }
    mark_all_uses();
  }

  /// Simplices that are left out count as uses: their vertices belong to the mesh. Infinite ones
  /// that are final do not: nothing of them is in the mesh, and each of their vertices has finite
  /// ones.
  void mark_all_uses() {
    choose_all();
    for (std::size_t s = 0; s < part_.simplex_count(); ++s) {
      if (part_.fates[s] == Fate::kFinal) {
        const Corners corners = part_.finite_simplex(s);
        const std::uint8_t use = is_left_out(s, corners) ? kByFinal : kByFinal | kByEmitted;
        for (const VertexId v : corners) use_[v] |= use;
      } else if (part_.fates[s] == Fate::kKept) {
        ++kept_;
        for (const VertexId v : part_.simplex(s)) {
          if (v != kInfiniteVertex) use_[v] |= kByBorder;
        }
      }
    }
  }

  [[nodiscard]] bool is_left_out(std::size_t s, const Corners& corners) const {
    return choices_.empty() ? is_too_long(corners) : choices_[s] == Choice::kLeftOut;
  }

  /// In a periodic domain, of the simplices that are final.
  void choose_all() {
    if constexpr (D <= kMostPeriodic) {
      if (!chooses()) return;
      choices_.resize(part_.simplex_count(), Choice::kInside);
      for (std::size_t s = 0; s < choices_.size(); ++s) {
        if (part_.fates[s] == Fate::kFinal) choices_[s] = choice_of(part_.finite_simplex(s));
      }
    }
  }

  /// To be asked once of each.
  Choice choice_of(const Corners& corners) {
    if constexpr (D <= kMostPeriodic) {
      if (!chosen_->is_inside(corners)) return chosen_->choose(corners);
    }
    return Choice::kInside;
  }

  /// The same where nothing is left out, or copies only, without a look at most simplices. A vertex
  /// without kept ones has final ones. Of a vertex with kept ones, a final one is the neighbour of a
  /// kept one, as its finite simplices are connected, and each of its infinite ones is beside a
  /// finite one.
  void mark_uses_from_border() {
    std::fill(use_.begin(), use_.end(), kByFinal | kByEmitted);
    for (const DroppedDuplicate& duplicate : part_.duplicates) {
      use_[duplicate.dropped - part_.first_vertex] = 0;
    }
    part_.for_each_open([&](std::size_t s, std::size_t place) {
      if (part_.fates[s] != Fate::kKept) return;
      ++kept_;
      for (const VertexId v : part_.open_simplex(place)) {
        if (v != kInfiniteVertex) use_[v] = kByBorder;
      }
    });
    part_.for_each_open([&](std::size_t s, std::size_t place) {
      if (part_.fates[s] != Fate::kKept) return;
      const Corners corners = part_.open_simplex(place);
      for (int i = 0; i <= D; ++i) {
        if (part_.fates[part_.open_simplices[place].neighbours[i]] != Fate::kFinal) continue;
        for (int k = 0; k <= D; ++k) {
          if (k != i) use_[corners[k]] |= kByFinal | kByEmitted;
        }
      }
    });
  }

  void announce_vertices() {
    MeshStreamBlock& mesh = result_.mesh;
    mesh.vertices.resize(use_.size());
    hashes_.resize(use_.size());
    if (output_.input_index) mesh.input_index.resize(use_.size());
    std::uint32_t count = 0;
    for (VertexId v = 0; v < use_.size(); ++v) {
      part_.expect(v + kAhead);
      if ((use_[v] & kByFinal) == 0 || part_.place(v).announced()) continue;
      const BorderVertex<D>& vertex = part_.vertex(v);
      mesh.vertices[count] = output_point(vertex);
      if (output_.input_index) mesh.input_index[count] = vertex.input_index;
      carry(v, mesh.attributes);
      hashes_[count] = fingerprint(vertex);
      short_number_[v] = count++;
    }
    mesh.vertices.resize(count);
    hashes_.resize(count);
    if (output_.input_index) mesh.input_index.resize(count);
  }

  void import_and_finalize() {
    MeshStreamBlock& mesh = result_.mesh;
    result_.border.dimension = part_.dimension();
    mesh.finalized.resize(use_.size());
    std::uint32_t* finalized = mesh.finalized.data();
    for (VertexId v = 0; v < use_.size(); ++v) {
      const StreamPlace place = part_.place(v);
      const bool kept = (use_[v] & kByBorder) != 0;
      if (place.announced() && ((use_[v] & kByEmitted) != 0 || !kept)) import(v);
      if (!kept) {
        if (use_[v] != 0 || place.announced()) *finalized++ = short_number_[v];
        continue;
      }
      kept_number_[v] = static_cast<VertexId>(result_.border.vertices.size());
      result_.border.vertices.push_back(part_.vertex(v));
      carry(v, result_.border.attributes);
      if (!place.announced() && (use_[v] & kByFinal) != 0) {
        result_.border.vertices.back().place = {part_.block, short_number_[v]};
      }
    }
    mesh.finalized.resize(static_cast<std::size_t>(finalized - mesh.finalized.data()));
  }

  void import(VertexId v) {
    const BorderVertex<D>& vertex = part_.vertex(v);
    short_number_[v] = static_cast<std::uint32_t>(hashes_.size());
    hashes_.push_back(fingerprint(vertex));
    result_.imported.push_back(vertex.place);
    if (!output_.imported_vertices) return;
    result_.imported_vertices.push_back(output_point(vertex));
    if (output_.input_index) result_.imported_index.push_back(vertex.input_index);
    carry(v, result_.imported_attributes);
  }

  /// Appends the attributes of a vertex to those of others.
  void carry(VertexId v, std::vector<std::byte>& attributes) const {
    const std::size_t size = output_.record_size;
    if (size == 0) return;
    const std::byte* const record = part_.record(v, size);
    attributes.insert(attributes.end(), record, record + size);
  }

  void list_simplices() {
    const std::size_t count = part_.simplex_count();
    result_.final_simplices = count - kept_;
    result_.border.simplices.reserve(kept_);
    if (!part_.exposure.empty()) result_.border.exposure.reserve(kept_);
    result_.mesh.corners.reserve((D + 1) * (count - kept_));
    std::size_t s = 0;
    // Most are final; those that may not be are few, if they are known.
    part_.for_each_open([&](std::size_t open, std::size_t place) {
      if (part_.fates[open] == Fate::kFinal) return;
      list_final(s, open);
      if (part_.fates[open] == Fate::kKept) {
        keep(part_.open_simplex(place), place);
      } else if (is_on_hull(part_.open_simplex(place))) {
        ++result_.hull_facets;
      }
      s = open + 1;
    });
    list_final(s, count);
    pass_on_listed();
    if constexpr (D <= kMostPeriodic) {
      if (chosen_) result_.torus = chosen_->proof();
    }
  }

  /// Whether the facet of an infinite simplex is one of the mesh.
  bool is_on_hull(const Corners& corners) {
    if constexpr (D <= kMostPeriodic) {
      if (chosen_) return chosen_->choose_infinite(corners);
    }
    return true;
  }

  /// Lists final simplices from `s` on, but those that are left out.
  void list_final(std::size_t s, std::size_t until) {
    while (s < until) {
      if (listed_ == kListed) pass_on_listed();
      const std::size_t end = std::min(until, s + (kListed - listed_));
      if (output_.max_edge) {
        list_short(s, end);
      } else if (!chooses()) {
        list(s, end);
      } else if constexpr (D <= kMostPeriodic) {
        list_chosen(s, end);
      }
      s = end;
    }
  }

  void list_short(std::size_t s, std::size_t end) {
    for (; s < end; ++s) {
      if (is_too_long(part_.finite_simplex(s))) {
        ++result_.left_out;
      } else {
        list(s, s + 1);
      }
    }
  }

  /// Whether the domain is periodic, and other copies may stand for simplices.
  [[nodiscard]] bool chooses() const {
    if constexpr (D <= kMostPeriodic) return chosen_ && !chosen_->all_chosen();
    return false;
  }

  void list_chosen(std::size_t s, std::size_t end) {
    while (s < end) {
      Choice choice = Choice::kInside;
      std::size_t inside = s;
      for (; inside < end; ++inside) {
        choice = choices_.empty() ? choice_of(part_.finite_simplex(inside)) : choices_[inside];
        if (choice != Choice::kInside) break;
      }
      list(s, inside);
      if (inside == end) return;
      s = inside + 1;
      if (choice == Choice::kAcross) {
        list(inside, s, [this](const Corners& corners) { return chosen_->ordered(corners); });
      }
    }
  }

  /// Lists and hashes simplices for which there is room.
  template <typename Order = std::identity>
  void list(std::size_t begin, std::size_t end, const Order& order = {}) {
    const std::uint32_t* const numbers = short_number_.get();
    const std::uint64_t* const hashes = hashes_.data();
    CanonicalHash<D> hash;
    std::array<std::uint32_t, D + 1>* next = &list_[listed_];
    for (std::size_t s = begin; s < end; ++s, ++next) {
      const Corners corners = order(part_.finite_simplex(s));
      std::uint64_t sum = 0;
      for (int i = 0; i <= D; ++i) {
        const std::uint32_t number = numbers[corners[i]];
        (*next)[i] = number;
        sum += hashes[number];
      }
      hash.add(sum);
    }
    listed_ += end - begin;
    result_.hash.add(hash);
  }

  /// Appends what was listed to the block: memory that nobody has cleared.
  void pass_on_listed() {
    const std::span<const std::uint32_t> corners(list_[0].data(), (D + 1) * listed_);
    result_.mesh.corners.insert(result_.mesh.corners.end(), corners.begin(), corners.end());
    listed_ = 0;
  }

  void keep(Corners corners, std::size_t place) {
    for (VertexId& v : corners) {
      if (v != kInfiniteVertex) v = kept_number_[v];
    }
    result_.border.simplices.push_back(corners);
    if (!part_.exposure.empty()) result_.border.exposure.push_back(part_.exposure[place]);
  }

  /// In output coordinates.
  [[nodiscard]] Point<D> world(Point<D> position) const {
    if (!output_.lattice) return position;
    for (int k = 0; k < D; ++k) position[k] = output_.lattice->to_world(k, position[k]);
    return position;
  }

  /// Of a vertex of the mesh.
  [[nodiscard]] std::uint64_t fingerprint(const BorderVertex<D>& vertex) const {
    if constexpr (D <= kMostPeriodic) {
      if (chosen_) return vertex_hash<D>(world(chosen_->in_box(vertex.position)));
    }
    return vertex_hash<D>(world(vertex.position));
  }

  /// Whether a finite simplex has too long an edge.
  [[nodiscard]] bool is_too_long(const Corners& corners) const {
    if (!output_.max_edge) return false;
    std::array<Point<D>, D + 1> positions;
    for (int i = 0; i <= D; ++i) positions[i] = world(part_.position(corners[i]));
    return has_longer_edge<D>(positions, *output_.max_edge);
  }

  [[nodiscard]] std::vector<Point<D>> positions() const {
    std::vector<Point<D>> positions(part_.vertex_count());
    for (VertexId v = 0; v < positions.size(); ++v) positions[v] = part_.position(v);
    return positions;
  }

  const Part& part_;
  const OutputOptions& output_;
  std::vector<std::uint8_t> use_;                  // by vertex
  std::unique_ptr<std::uint32_t[]> short_number_;  // by vertex, if it is in the mesh block
  std::unique_ptr<VertexId[]> kept_number_;        // by vertex, if it is in the border
  std::vector<std::uint64_t> hashes_;              // by short number
  std::optional<ChosenSimplices<std::min(D, kMostPeriodic)>> chosen_;  // in a periodic domain
  std::vector<Choice> choices_;  // by simplex; empty: not yet known
  std::size_t kept_ = 0;         // simplices
  std::array<std::array<std::uint32_t, D + 1>, kListed> list_;
  std::size_t listed_ = 0;
  Settled<D> result_;
};

}  // namespace

template <int D, template <int> typename Part>
Settled<D> settle(const Part<D>& part, const OutputOptions& output) {
  return Settlement<D, Part<D>>(part, output).run();
}

#define SPILLWAY_INSTANTIATE(D)                                              \
  template Settled<D> settle(const MergeToSettle<D>&, const OutputOptions&); \
  template Settled<D> settle(const LeafToSettle<D>&, const OutputOptions&);
SPILLWAY_FOR_EACH_DIMENSION(SPILLWAY_INSTANTIATE)
#undef SPILLWAY_INSTANTIATE

}  // namespace spillway::stream
