#include "stream/checker/stream_proof.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <unordered_map>

#include <spillway/detail/probing_table.h>
#include "src/geometry/canonical_hash.h"
#include "src/geometry/dimensions.h"
#include "src/parallel/parallel.h"
#include "stream/checker/mesh_proof.h"
#include "stream/checker/needed_vertices.h"
#include "stream/checker/torus_boundary.h"

namespace spillway::checker {
namespace {

// A facet that one simplex has so far. 24 bytes.
template <int D>
struct UnpairedFacet {
  static constexpr std::uint64_t kEmpty = ~std::uint64_t{0} >> 20;

  std::array<std::uint32_t, D> facet{};  // slots, sorted
  std::uint32_t apex = 0;                // slot
  std::uint64_t simplex : 44 = kEmpty;
  std::uint64_t offsets : 12 = 0;     // of the second and the third corner, seen from the first
  std::uint64_t apex_offset : 6 = 0;  // likewise
  std::uint64_t odd : 1 = 0;          // as SortedFacet says
  std::uint64_t positive : 1 = 0;     // whether the simplex is

  [[nodiscard]] bool empty() const { return simplex == kEmpty; }
  [[nodiscard]] bool same_key(const UnpairedFacet& other) const {
    return same_numbers(facet, other.facet) && offsets == other.offsets;
  }
  [[nodiscard]] std::uint64_t scattered() const {
    std::uint64_t key = std::uint64_t{facet[0]} << 32 | facet[1];
    for (int i = 2; i < D; ++i) key = scatter(key) + facet[i];
    return scatter(key + offsets);
  }
};

// A simplex of a periodic mesh, seen from the first corner of one of its facets: that is in the
// box, so that all corners are exact, as none is a period away from another one.
template <int D>
struct FacetFrame {
  std::array<Point<D>, D + 1> corners{};
  bool fits = true;  // all offsets are -1, 0 or 1
};

// Blocks that are examined at once.
template <int D>
struct Batch {
  std::vector<StreamBlock<D>> blocks;
  std::size_t count = 0;  // how many of them, the first ones, are in use
};

template <int D>
class StreamProof {
 public:
  StreamProof(MeshStreamReader& reader, const CheckerOptions& options, StreamTask task,
              CheckReport& report)
      : reader_(reader),
        options_(options),
        task_(task),
        report_(report),
        faults_(report, options.most_faults),
        coordinates_(reader.header(), options.input_lattice) {
    low_.fill(std::numeric_limits<double>::infinity());
    high_.fill(-std::numeric_limits<double>::infinity());
  }

  void run() {
    Batch<D> now;
    Batch<D> next;
    read(now);
    while (now.count > 0) {
      TaskGroup group;
      group.run([this, &now] {
        parallel_for(now.count, 1, [&](std::size_t b, std::size_t, std::size_t) {
          now.blocks[b].examine(coordinates_, options_, task_);
        });
      });
      read(next);
      group.wait();
      for (std::size_t b = 0; b < now.count; ++b) join(now.blocks[b]);
      if (options_.progress) options_.progress(simplices_joined_, reader_.fraction_read());
      std::swap(now, next);
    }
    report_.vertices = vertices_.announced();
    report_.simplices = simplices_joined_;
    report_.hull_facets = facets_.size();
    report_.peak_live_vertices = vertices_.peak();
    if (task_ == StreamTask::kProve) conclude();
    compare_totals();
  }

 private:
  // A batch has at least kManyCorners of many small blocks, or kEnoughBlocks of middling ones.
  static constexpr std::size_t kManyCorners = std::size_t{1} << 14;
  static constexpr std::size_t kEnoughBlocks = 8;
  static constexpr std::size_t kMostCorners = std::size_t{1} << 20;

  template <typename... Args>
  void prove(fmt::format_string<Args...> format, Args&&... args) {
    report_.proved.push_back(fmt::format(format, std::forward<Args>(args)...));
  }

  void read(Batch<D>& batch) {
    batch.count = 0;
    std::size_t corners = 0;
    while (corners < kManyCorners || (batch.count < kEnoughBlocks && corners < kMostCorners)) {
      if (batch.count == batch.blocks.size()) batch.blocks.emplace_back();
      StreamBlock<D>& block = batch.blocks[batch.count];
      if (!reader_.read(block.block)) return;
      enter(block);
      ++batch.count;
      corners += block.block.corners.size() + block.block.vertices.size();
    }
  }

  // Gives a block's vertices their slots and coordinates.
  void enter(StreamBlock<D>& block) {
    const MeshStreamBlock& mesh = block.block;
    block.first_vertex = vertices_.announced();
    block.first_simplex = simplices_entered_;
    simplices_entered_ += block.simplices();
    block.points.clear();
    for (const LatticePoint& vertex : mesh.vertices) {
      const Point<D> point = coordinates_.for_predicates(mesh.vertex<D>(block.points.size()));
      const int axis = coordinates_.axis_off_lattice(vertex);
      if (axis >= 0) report_off_lattice(block.first_vertex + block.points.size(), vertex, axis);
      if (coordinates_.torus()) enter_in_box(block, point);
      block.points.push_back(point);
      if (options_.vertex) {
        options_.vertex(coordinates_.block_to_output(vertex),
                        std::as_bytes(further_part<D>(point)));
      }
    }
    vertices_.enter(mesh, block.points, block.slots);
  }

  // A vertex must lie in the periodic box, where its copies are exact.
  void enter_in_box(const StreamBlock<D>& block, const Point<D>& point) {
    for (int k = 0; k < D; ++k) {
      low_[k] = std::min(low_[k], point[k]);
      high_[k] = std::max(high_[k], point[k]);
    }
    Point<D> wrapped = point;
    const Wrapping wrapping = coordinates_.torus()->wrap(wrapped);
    if (task_ == StreamTask::kCount || !(wrapping.moved || wrapping.rounded)) return;
    ++outside_;
    const NamedVertex<D> vertex{block.first_vertex + block.points.size(),
                                coordinates_.to_output(point)};
    faults_.add("{} is {}", vertex_text<D>(vertex),
                wrapping.moved ? "outside of the periodic box"
                               : "no multiple of the step at which its copies are exact");
  }

  void report_off_lattice(std::uint64_t number, const LatticePoint& vertex, int axis) {
    if (task_ == StreamTask::kCount) return;
    ++report_.off_lattice;
    const IntegerLattice& lattice = *coordinates_.lattice();
    NamedVertex<D> named{number, {}};
    std::copy_n(coordinates_.block_to_output(vertex).begin(), std::min(D, kOwnAxes),
                named.point.begin());
    faults_.add("{} is off the lattice: its {} is no integer * {} + {}", vertex_text<D>(named),
                "xyz"[axis], lattice.scale[axis], lattice.offset[axis]);
  }

  // Adds an examined block to those before it.
  void join(const StreamBlock<D>& block) {
    faults_.add(block.found);
    report_.canonical_hash += block.canonical_hash;
    simplices_joined_ += block.simplices();
    inner_ += block.inner_facets;
    not_delaunay_ += block.not_delaunay;
    not_positive_ += block.not_positive;
    volume_ += block.volume;
    for (std::size_t v = 0; v < block.slots.size(); ++v) {
      if (block.used[v]) vertices_[block.slots[v]].used = true;
    }
    for (const std::uint32_t facet : block.open) match(block, facet);
    report_.peak_open_facets = std::max<std::uint64_t>(report_.peak_open_facets, facets_.size());
    for (const std::uint32_t vertex : block.block.finalized) {
      const std::uint32_t slot = block.slots[vertex];
      require_used(vertices_[slot]);
      vertices_.finalize(slot);
    }
  }

  void require_used(const typename NeededVertices<D>::Vertex& vertex) {
    if (vertex.used || task_ == StreamTask::kCount) return;
    ++unused_;
    faults_.add("{} is in no {}", vertex_text<D>(named(vertex)), Words<D>::kSimplex);
  }

  // A facet of the block meets the one that earlier blocks left open, or is open itself.
  void match(const StreamBlock<D>& block, std::uint32_t number) {
    const std::size_t s = number / (D + 1);
    const int opposite = static_cast<int>(number % (D + 1));
    std::array<std::uint32_t, D + 1> slots;
    for (int i = 0; i <= D; ++i) slots[i] = block.slots[block.block.corners[s * (D + 1) + i]];
    UnpairedFacet<D> entry;
    FacetFrame<D> frame;
    if (number >= block.first_across()) {
      frame = sort_across(block, s, opposite, slots, entry);
      if (!frame.fits) return report_far_corners(block, s);
    } else {
      const SortedFacet<D> facet(slots.data(), opposite);
      entry.facet = facet.vertices;
      entry.apex = slots[opposite];
      entry.odd = facet.odd ? 1 : 0;
      if (coordinates_.torus()) frame.corners = block.simplex(s, coordinates_);
    }
    entry.simplex = block.first_simplex + s;
    entry.positive = block.positive[s] ? 1 : 0;
    UnpairedFacet<D>* older = facets_.find(entry);
    if (older == nullptr) {
      for (const std::uint32_t slot : slots) vertices_.hold(slot);
      facets_.insert(entry);
      return;
    }
    if (task_ == StreamTask::kProve && older->apex == entry.apex &&
        older->apex_offset == entry.apex_offset) {
      // The older one stays, as if it were alone.
      if (last_twin_ != entry.simplex) {
        faults_.add("{} has the same vertices as {} {}", block.text(s, coordinates_),
                    Words<D>::kSimplex, std::uint64_t{older->simplex});
      }
      last_twin_ = entry.simplex;
      return;
    }
    if (task_ == StreamTask::kProve) prove_facet(block, s, entry, *older, frame);
    for (const std::uint32_t slot : older->facet) vertices_.release(slot);
    vertices_.release(older->apex);
    facets_.erase(older);
  }

  [[nodiscard]] Point<D> moved(Point<D> point, std::uint64_t offset) const {
    for (int k = 0; k < std::min(D, 3); ++k) {
      const int periods = periods_along(static_cast<CornerOffset>(offset), k);
      point[k] = coordinates_.torus()->moved(k, point[k], periods);
    }
    return point;
  }

  // Fills facet, apex, their offsets and `odd` for a simplex with offsets.
  FacetFrame<D> sort_across(const StreamBlock<D>& block, std::size_t s, int opposite,
                            const std::array<std::uint32_t, D + 1>& slots,
                            UnpairedFacet<D>& entry) {
    FacetFrame<D> frame;
    if constexpr (D <= 3) {
      std::array<std::array<int, 3>, D + 1> periods;
      std::array<int, D> order;
      for (int i = 0, n = 0; i <= D; ++i) {
        for (int k = 0; k < 3; ++k) {
          periods[i][k] = periods_along(block.offset(s * (D + 1) + i), k);
        }
        if (i != opposite) order[n++] = i;
      }
      const auto before = [&](int a, int b) {
        return std::pair(slots[a], periods[a]) < std::pair(slots[b], periods[b]);
      };
      bool odd = (D - opposite) % 2 == 0;
      for (int last = D - 1; last > 0; --last) {
        for (int j = 0; j < last; ++j) {
          if (!before(order[j + 1], order[j])) continue;
          std::swap(order[j], order[j + 1]);
          odd = !odd;
        }
      }
      const std::array<int, 3> first = periods[order[0]];
      std::array<std::uint64_t, D + 1> codes;
      for (int i = 0; i <= D; ++i) {
        for (int k = 0; k < 3; ++k) {
          periods[i][k] -= first[k];
          frame.fits &= std::abs(periods[i][k]) <= 1;
        }
        codes[i] = static_cast<std::uint64_t>(corner_offset(periods[i]));
        frame.corners[i] = moved(block.points[block.block.corners[s * (D + 1) + i]], codes[i]);
      }
      for (int j = 0; j < D; ++j) entry.facet[j] = slots[order[j]];
      entry.offsets = D == 3 ? codes[order[1]] | codes[order[D - 1]] << 6 : codes[order[1]];
      entry.apex = slots[opposite];
      entry.apex_offset = codes[opposite];
      entry.odd = odd ? 1 : 0;
    }
    return frame;
  }

  void report_far_corners(const StreamBlock<D>& block, std::size_t s) {
    if (last_twin_ == block.first_simplex + s) return;
    last_twin_ = block.first_simplex + s;
    faults_.add("{} has corners more than a period apart", block.text(s, coordinates_));
  }

  void prove_facet(const StreamBlock<D>& block, std::size_t s, const UnpairedFacet<D>& facet,
                   const UnpairedFacet<D>& older, const FacetFrame<D>& frame) {
    if (facet.positive == 0 || older.positive == 0) return;
    if (facet.odd == older.odd) {
      faults_.add("{} and {} overlap: they lie on the same side of their common {}", text(older),
                  block.text(s, coordinates_), Words<D>::kFacet);
      return;
    }
    ++inner_;
    const auto& apex = vertices_[older.apex];
    const ApexSide side =
        coordinates_.torus()
            ? apex_side<D>(frame.corners, moved(apex.point, older.apex_offset), options_)
            : apex_side<D>(block.simplex(s, coordinates_), apex.point, options_);
    if (side == ApexSide::kOutside) return;
    ++not_delaunay_;
    faults_.add_apex(side, block.text(s, coordinates_), vertex_text<D>(named(apex)), text(older));
  }

  [[nodiscard]] NamedVertex<D> named(const typename NeededVertices<D>::Vertex& vertex) const {
    return {vertex.number, coordinates_.to_output(vertex.point)};
  }
  [[nodiscard]] std::string text(const UnpairedFacet<D>& facet) const {
    std::array<NamedVertex<D>, D + 1> names;
    for (int i = 0; i < D; ++i) names[i] = named(vertices_[facet.facet[i]]);
    names[D] = named(vertices_[facet.apex]);
    return simplex_text<D>(facet.simplex, names);
  }

  // What holds once all blocks have come, and whether the boundary closes them.
  void conclude() {
    vertices_.for_each_not_finalized([this](const auto& vertex) { require_used(vertex); });
    if (simplices_joined_ == 0) faults_.add("the mesh has no {}", Words<D>::kSimplices);
    if (coordinates_.lattice() && report_.off_lattice == 0) {
      prove("all {} vertices are on the lattice", report_.vertices);
      report_.on_lattice = coordinates_.on_lattice();
    }
    if (unused_ == 0) prove("all {} vertices are used", report_.vertices);
    if (not_positive_ == 0) {
      prove("all {} {} are positively oriented", report_.simplices, Words<D>::kSimplices);
    }
    if (coordinates_.torus() && outside_ == 0) {
      prove("all {} vertices are in the periodic box, and their copies exact", report_.vertices);
    }
    const bool matched =
        faults_.count() == report_.off_lattice + unused_ + not_delaunay_ + outside_;
    if (!matched) return;
    prove("every {} is in two {} or on the boundary", Words<D>::kFacet, Words<D>::kSimplices);
    if (not_delaunay_ == 0) {
      prove("all {} inner {}s are locally Delaunay{}{}", inner_, Words<D>::kFacet,
            options_.any_delaunay ? "" : ", ties broken canonically",
            report_.on_lattice ? ", on the integers of the lattice" : "");
    }
    if (coordinates_.torus()) return check_torus();
    const std::uint64_t before = faults_.count();
    check_boundary();
    if (faults_.count() == before) {
      prove("the {} boundary {}s form one convex surface: the {} cover the hull exactly once",
            report_.hull_facets, Words<D>::kFacet, Words<D>::kSimplices);
      if (unused_ == 0) prove("no two vertices are equal, as that would cover some place twice");
    }
  }

  // The mesh of all copies covers each place equally often, but beyond its boundary, so that volumes
  // add up to a multiple of the hull's: a sum that is rounded tells which one.
  void check_torus() {
    if constexpr (D <= 3) {
      std::vector<std::array<Point<D>, D>> facets;
      facets_.for_each([&](const UnpairedFacet<D>& facet) {
        std::array<Point<D>, D>& points = facets.emplace_back();
        points[0] = vertices_[facet.facet[0]].point;
        for (int i = 1; i < D; ++i) {
          points[i] = moved(vertices_[facet.facet[i]].point, facet.offsets >> (6 * (i - 1)) & 63);
        }
      });
      const TorusBoundary boundary = torus_boundary<D>(*coordinates_.torus(), low_, high_, facets);
      if (!boundary.fault.empty()) return faults_.add("{}", boundary.fault);
      constexpr double kRounding = 1e-3;
      const double times = volume_ / ((D == 2 ? 2 : 6) * boundary.volume);
      if (!(std::abs(times - 1) <= kRounding)) {
        return faults_.add("the {} cover the periodic box {:.6g} times", Words<D>::kSimplices,
                           times);
      }
      prove("the volumes of the {} sum to that of the {}: they cover it exactly once",
            Words<D>::kSimplices,
            coordinates_.torus()->closed() ? "periodic box" : "hull in the periodic box");
    }
  }

  // Makes a mesh of the simplices at the boundary, for the proof that meshes in memory have.
  void check_boundary() {
    std::vector<UnpairedFacet<D>> facets;
    facets_.for_each([&](const UnpairedFacet<D>& facet) { facets.push_back(facet); });
    std::sort(facets.begin(), facets.end(), [this](const auto& a, const auto& b) {
      return std::pair(std::uint64_t{a.simplex}, vertices_[a.apex].number) <
             std::pair(std::uint64_t{b.simplex}, vertices_[b.apex].number);
    });
    Mesh mesh;
    mesh.header.dimension = D;
    mesh.header.attributes = further_coordinates(D);
    MeshNumbers numbers;
    std::vector<Point<D>> points;
    std::unordered_map<std::uint32_t, std::uint64_t> number_of_slot;
    const auto vertex_of = [&](std::uint32_t slot) {
      const auto [it, is_new] = number_of_slot.try_emplace(slot, points.size());
      if (is_new) {
        const NamedVertex<D> vertex = named(vertices_[slot]);
        numbers.vertices.push_back(vertex.number);
        points.push_back(vertices_[slot].point);
        mesh.vertices.emplace_back(own_coordinates<D>(vertex.point));
        append_further_coordinates<D>(vertex.point, mesh.attributes);
      }
      return it->second;
    };
    std::vector<BoundaryFacet<D>> boundary;
    for (const UnpairedFacet<D>& facet : facets) {
      BoundaryFacet<D> outwards;
      std::transform(facet.facet.begin(), facet.facet.end(), outwards.vertices.begin(), vertex_of);
      if (facet.odd != 0) std::swap(outwards.vertices[0], outwards.vertices[1]);
      outwards.simplex = boundary.size();
      boundary.push_back(outwards);
      std::swap(outwards.vertices[0], outwards.vertices[1]);
      mesh.corners.insert(mesh.corners.end(), outwards.vertices.begin(), outwards.vertices.end());
      mesh.corners.push_back(vertex_of(facet.apex));
      numbers.simplices.push_back(facet.simplex);
    }
    MeshView<D> view(mesh, &numbers);
    view.points() = std::move(points);
    prove_boundary<D>(view, boundary, faults_);
  }

  // The trailer says what was found.
  void compare_totals() {
    if (!reader_.has_hash()) return;
    const MeshTotals& totals = reader_.totals();
    const std::uint64_t before = faults_.count();
    const auto compare = [this](const char* what, std::uint64_t found, std::uint64_t promised) {
      if (found != promised) {
        faults_.add("the mesh has {} {}, but its trailer says {}", found, what, promised);
      }
    };
    compare("vertices", report_.vertices, totals.vertices);
    compare(Words<D>::kSimplices, report_.simplices, totals.simplices);
    compare("hull facets", report_.hull_facets, totals.hull_facets);
    if (report_.canonical_hash != totals.canonical_hash) {
      faults_.add("the mesh has the hash {}, but its trailer says {}",
                  hash_to_hex(report_.canonical_hash), hash_to_hex(totals.canonical_hash));
    }
    if (faults_.count() == before) prove("numbers and hash are those of the trailer");
  }

  MeshStreamReader& reader_;
  const CheckerOptions& options_;
  const StreamTask task_;
  CheckReport& report_;
  Faults faults_;
  const StreamCoordinates<D> coordinates_;
  NeededVertices<D> vertices_;
  ProbingTable<UnpairedFacet<D>> facets_;
  std::uint64_t simplices_entered_ = 0;  // of blocks that have been read
  std::uint64_t simplices_joined_ = 0;   // of blocks that join() has seen
  std::uint64_t inner_ = 0;              // facets with two positive simplices
  std::uint64_t not_delaunay_ = 0;       // of these
  std::uint64_t not_positive_ = 0;       // simplices
  std::uint64_t unused_ = 0;             // vertices
  std::uint64_t outside_ = 0;            // of the periodic box, or inexact: vertices
  double volume_ = 0;                    // of a periodic mesh, times D!, rounded
  Point<D> low_{};                       // of the vertices of a periodic mesh
  Point<D> high_{};
  std::uint64_t last_twin_ = ~std::uint64_t{0};  // the last simplex reported as one
};

}  // namespace

template <int D>
void prove_stream(MeshStreamReader& reader, const CheckerOptions& options, StreamTask task,
                  CheckReport& report) {
  with_threads(options.threads == 0 ? available_threads() : options.threads,
               [&] { StreamProof<D>(reader, options, task, report).run(); });
}

#define SPILLWAY_INSTANTIATE(D) \
  template void prove_stream<D>(MeshStreamReader&, const CheckerOptions&, StreamTask, CheckReport&);
SPILLWAY_FOR_EACH_DIMENSION(SPILLWAY_INSTANTIATE)
#undef SPILLWAY_INSTANTIATE

}  // namespace spillway::checker
