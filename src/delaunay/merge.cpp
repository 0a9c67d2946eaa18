#include "src/delaunay/merge.h"

#include <algorithm>
#include <atomic>
#include <numeric>
#include <stdexcept>
#include <string>
#include <utility>

#include "src/delaunay/hash.h"
#include "src/delaunay/schedule.h"
#include "src/error.h"
#include "src/parallel/parallel.h"

namespace spillway {
namespace {

constexpr std::size_t kGrain = 4096;

/// Whether two facets have the same vertices.
template <std::size_t N>
bool same_facet(std::array<VertexId, N> a, std::array<VertexId, N> b) {
  std::sort(a.begin(), a.end());
  std::sort(b.begin(), b.end());
  return a == b;
}

/// The vertices of a simplex without the i-th.
template <std::size_t N>
std::array<VertexId, N - 1> facet_vertices(const std::array<VertexId, N>& vertices, int i) {
  std::array<VertexId, N - 1> facet;
  std::copy(vertices.begin(), vertices.begin() + i, facet.begin());
  std::copy(vertices.begin() + i + 1, vertices.end(), facet.begin() + i);
  return facet;
}

/// The place in `a` of the vertex that its neighbour `b` does not have.
template <std::size_t N>
int opposite_place(const std::array<VertexId, N>& a, const std::array<VertexId, N>& b) {
  int i = 0;
  while (std::find(b.begin(), b.end(), a[i]) != b.end()) ++i;
  return i;
}

/// One merge. The steps are called in the order in which they stand here.
template <int D>
class Merge {
 public:
  Merge(Triangulation<D>& triangulation, std::span<BlockMarks> marks, const Part<D>& part,
        std::span<PartSurface> children)
      : triangulation_(triangulation), marks_(marks), part_(part), children_(children) {}

  /// Step 1: border_ and border_vertices_.
  void find_borders(Task& task);

  /// The share of the part's points that are in borders.
  [[nodiscard]] double border_share() const {
    return static_cast<double>(border_vertices_.size()) / static_cast<double>(part_.size());
  }

  /// Step 2: border_mesh_, its vertices renumbered to those of triangulation_.
  void triangulate_border(const BorderTriangulator<D>& triangulate, Task& task);

  /// Step 3: targets_, the new block's vertices, marks of survivors.
  void accept(Task& task);

  /// Step 4: neighbours of the new simplices and back; removes what did not survive.
  void link(Task& task);

  PartSurface surface();

 private:
  using Vertices = std::array<VertexId, D + 1>;

  /// A facet between a simplex of the border that is removed and one outside of the border.
  struct OpenFacet {
    SimplexId removed;
    int place;  ///< of the removed simplex's vertex opposite the facet
  };
  /// Two simplices that become neighbours: a new one, and one of a child.
  struct Link {
    SimplexId created;
    int created_place;
    SimplexId old;
    int old_place;
  };

  [[nodiscard]] std::size_t child_of(VertexId v) const {
    std::size_t c = 0;
    while (v >= part_.children[c].end) ++c;
    return c;
  }
  /// The child that has all finite vertices, or kSpans.
  static constexpr std::size_t kSpans = ~std::size_t{0};
  [[nodiscard]] std::size_t only_child(const Vertices& vertices) const {
    std::size_t only = kSpans;
    for (const VertexId v : vertices) {
      if (v == kInfiniteVertex) continue;
      const std::size_t c = child_of(v);
      if (only != kSpans && only != c) return kSpans;
      only = c;
    }
    return only;
  }
  std::atomic_ref<Mark> mark(SimplexId id) {
    return std::atomic_ref<Mark>(marks_[id.block][id.index]);
  }
  [[nodiscard]] const Vertices& vertices(SimplexId id) const {
    return triangulation_.simplex(id).vertices;
  }
  SimplexBlock<D>& new_block() { return triangulation_.blocks[part_.block]; }
  [[nodiscard]] bool created(SimplexId target) const { return target.block == part_.block; }
  [[nodiscard]] std::size_t flat(SimplexId id) const {
    return first_of_block_[id.block] + id.index;
  }

  [[nodiscard]] std::vector<VertexId> vertices_of(const std::vector<SimplexId>& simplices,
                                                  const Part<D>& child) const;
  [[nodiscard]] std::vector<OpenFacet> open_facets();
  void link_simplex(SimplexId in_border_mesh, SimplexId created, const ConcurrentIndex& facet_index,
                    const std::vector<OpenFacet>& facets, std::vector<Link>& links);

  Triangulation<D>& triangulation_;
  std::span<BlockMarks> marks_;
  const Part<D>& part_;
  std::span<PartSurface> children_;

  std::vector<SimplexId> border_;          ///< of all children
  std::vector<VertexId> border_vertices_;  ///< sorted
  Triangulation<D> border_mesh_;
  std::vector<SimplexId> mesh_simplices_;    ///< of border_mesh_
  std::vector<std::size_t> first_of_block_;  ///< flat number of each block's first simplex
  /// By flat number in border_mesh_: the simplex of triangulation_ that it is or becomes, or
  /// kNoSimplex if it is dropped.
  std::vector<SimplexId> targets_;
};

template <int D>
void Merge<D>::find_borders(Task& task) {
  task.kind = "border";
  const Stopwatch watch(task.seconds);
  const std::size_t count = children_.size();
  std::vector<std::vector<SimplexId>> borders(count);
  std::vector<std::vector<VertexId>> vertices(count);
  TaskGroup group;
  for (std::size_t c = 0; c < count; ++c) {
    group.run([&, c] {
      if (children_[c].open) {
        vertices[c] = children_[c].vertices;
        return;
      }
      std::vector<const Part<D>*> others;
      for (std::size_t o = 0; o < count; ++o) {
        if (o != c) others.push_back(&part_.children[o]);
      }
      borders[c] = find_border<D>(triangulation_, children_[c].hull, others, marks_);
      vertices[c] = vertices_of(borders[c], part_.children[c]);
    });
  }
  group.wait();
  for (std::size_t c = 0; c < count; ++c) {
    border_.insert(border_.end(), borders[c].begin(), borders[c].end());
    border_vertices_.insert(border_vertices_.end(), vertices[c].begin(), vertices[c].end());
  }
  task.points = border_vertices_.size();
  task.pieces = std::max<std::size_t>(1, grain_count(border_.size(), kGrain));
}

/// The finite vertices of a child's simplices, sorted.
template <int D>
std::vector<VertexId> Merge<D>::vertices_of(const std::vector<SimplexId>& simplices,
                                            const Part<D>& child) const {
  std::vector<bool> seen(child.size());
  for (const SimplexId id : simplices) {
    for (const VertexId v : vertices(id)) {
      if (v != kInfiniteVertex) seen[v - child.begin] = true;
    }
  }
  std::vector<VertexId> sorted;
  for (VertexId v = child.begin; v < child.end; ++v) {
    if (seen[v - child.begin]) sorted.push_back(v);
  }
  return sorted;
}

template <int D>
void Merge<D>::triangulate_border(const BorderTriangulator<D>& triangulate, Task& task) {
  std::vector<Point<D>> points;
  points.reserve(border_vertices_.size());
  for (const VertexId v : border_vertices_) points.push_back(triangulation_.points[v]);
  border_mesh_ = triangulate(std::move(points), part_.size(), task);
  std::vector<VertexId> renumbered(border_mesh_.input_index.size());
  for (std::size_t v = 0; v < renumbered.size(); ++v) {
    renumbered[v] = border_vertices_[border_mesh_.input_index[v]];
  }
  std::size_t total = 0;
  for (SimplexBlock<D>& block : border_mesh_.blocks) {
    first_of_block_.push_back(total);
    total += block.simplices.size();
    parallel_for(block.simplices.size(), kGrain,
                 [&](std::size_t, std::size_t begin, std::size_t end) {
                   for (std::size_t i = begin; i < end; ++i) {
                     if (block.simplices[i].removed()) continue;
                     for (VertexId& v : block.simplices[i].vertices) {
                       if (v != kInfiniteVertex) v = renumbered[v];
                     }
                   }
                 });
  }
  targets_.assign(total, kNoSimplex);
  mesh_simplices_.reserve(total);
  border_mesh_.for_each_simplex(
      [&](SimplexId id, const Simplex<D>&) { mesh_simplices_.push_back(id); });
}

template <int D>
void Merge<D>::accept(Task& task) {
  task.kind = "accept";
  task.points = border_vertices_.size();
  task.pieces = std::max<std::size_t>(1, grain_count(mesh_simplices_.size(), kGrain));
  const Stopwatch watch(task.seconds);

  ConcurrentIndex index(border_.size());
  parallel_for(border_.size(), kGrain, [&](std::size_t, std::size_t begin, std::size_t end) {
    for (std::size_t b = begin; b < end; ++b) {
      index.insert(simplex_hash(vertices(border_[b])), static_cast<std::uint32_t>(b));
    }
  });

  std::vector<std::size_t> created(grain_count(mesh_simplices_.size(), kGrain) + 1);
  parallel_for(
      mesh_simplices_.size(), kGrain, [&](std::size_t g, std::size_t begin, std::size_t end) {
        std::uint32_t count = 0;
        for (std::size_t m = begin; m < end; ++m) {
          const Vertices& candidate = border_mesh_.simplex(mesh_simplices_[m]).vertices;
          SimplexId& target = targets_[flat(mesh_simplices_[m])];
          const std::size_t c = only_child(candidate);
          if (c == kSpans || children_[c].open) {
            target = {part_.block, count++};
            continue;
          }
          const std::uint32_t b = index.find(simplex_hash(candidate), [&](std::uint32_t item) {
            return same_simplex(candidate, vertices(border_[item]));
          });
          if (b == ConcurrentIndex::kNotFound) continue;
          target = border_[b];
          mark(target).store(Mark::kSurvivor, std::memory_order_relaxed);
        }
        created[g + 1] = count;
      });
  std::partial_sum(created.begin(), created.end(), created.begin());
  if (created.back() >= Simplex<D>::kLink || border_.size() >= Simplex<D>::kLink) {
    throw Error("the border of " + std::to_string(border_vertices_.size()) +
                " points has more simplices than fit into one block");
  }

  new_block().simplices.resize(created.back());
  marks_[part_.block].assign(created.back(), Mark::kInterior);
  parallel_for(mesh_simplices_.size(), kGrain,
               [&](std::size_t g, std::size_t begin, std::size_t end) {
                 for (std::size_t m = begin; m < end; ++m) {
                   SimplexId& target = targets_[flat(mesh_simplices_[m])];
                   if (target.block != part_.block) continue;
                   target.index += static_cast<std::uint32_t>(created[g]);
                   new_block().simplices[target.index].vertices =
                       border_mesh_.simplex(mesh_simplices_[m]).vertices;
                 }
               });
}

template <int D>
auto Merge<D>::open_facets() -> std::vector<OpenFacet> {
  std::vector<std::vector<OpenFacet>> found(grain_count(border_.size(), kGrain));
  parallel_for(border_.size(), kGrain, [&](std::size_t g, std::size_t begin, std::size_t end) {
    for (std::size_t b = begin; b < end; ++b) {
      if (mark(border_[b]).load(std::memory_order_relaxed) == Mark::kSurvivor) continue;
      for (int i = 0; i <= D; ++i) {
        const SimplexId other = triangulation_.neighbour(border_[b], i);
        if (mark(other).load(std::memory_order_relaxed) == Mark::kInterior) {
          found[g].push_back({border_[b], i});
        }
      }
    }
  });
  std::vector<OpenFacet> facets;
  for (const auto& some : found) facets.insert(facets.end(), some.begin(), some.end());
  return facets;
}

/// Sets the neighbours of a new simplex that are new too; collects the others as links.
template <int D>
void Merge<D>::link_simplex(SimplexId in_border_mesh, SimplexId created,
                            const ConcurrentIndex& facet_index,
                            const std::vector<OpenFacet>& facets, std::vector<Link>& links) {
  Simplex<D>& simplex = new_block().simplices[created.index];
  for (int i = 0; i <= D; ++i) {
    SimplexId other = targets_[flat(border_mesh_.neighbour(in_border_mesh, i))];
    if (other.block == part_.block) {
      simplex.neighbours[i] = other.index;
      continue;
    }
    if (other == kNoSimplex) {
      const auto facet = facet_vertices(simplex.vertices, i);
      const std::uint32_t f =
          facet_index.find(facet_hash(simplex.vertices, i), [&](std::uint32_t item) {
            return same_facet(facet,
                              facet_vertices(vertices(facets[item].removed), facets[item].place));
          });
      if (f == ConcurrentIndex::kNotFound) {
        throw std::logic_error("merge: a new simplex has no neighbour across one of its facets");
      }
      other = triangulation_.neighbour(facets[f].removed, facets[f].place);
    }
    simplex.neighbours[i] = SimplexBlock<D>::kUnlinked;
    links.push_back({created, i, other, opposite_place(vertices(other), simplex.vertices)});
  }
}

template <int D>
void Merge<D>::link(Task& task) {
  task.kind = "neighbours";
  task.points = border_vertices_.size();
  task.pieces = std::max<std::size_t>(1, grain_count(mesh_simplices_.size(), kGrain));
  const Stopwatch watch(task.seconds);

  const std::vector<OpenFacet> facets = open_facets();
  ConcurrentIndex facet_index(facets.size());
  parallel_for(facets.size(), kGrain, [&](std::size_t, std::size_t begin, std::size_t end) {
    for (std::size_t f = begin; f < end; ++f) {
      facet_index.insert(facet_hash(vertices(facets[f].removed), facets[f].place),
                         static_cast<std::uint32_t>(f));
    }
  });

  std::vector<std::vector<Link>> links(grain_count(mesh_simplices_.size(), kGrain));
  parallel_for(mesh_simplices_.size(), kGrain,
               [&](std::size_t g, std::size_t begin, std::size_t end) {
                 for (std::size_t m = begin; m < end; ++m) {
                   const SimplexId target = targets_[flat(mesh_simplices_[m])];
                   if (created(target)) {
                     link_simplex(mesh_simplices_[m], target, facet_index, facets, links[g]);
                   }
                 }
               });

  // A block's links are one array: the new block and each child's blocks are a task of their own.
  TaskGroup group;
  group.run([&] {
    for (const auto& some : links) {
      for (const Link& link : some) {
        new_block().set_neighbour(link.created, link.created_place, link.old);
      }
    }
  });
  std::uint32_t first_block = 0;
  for (const Part<D>& child : part_.children) {
    group.run([&, first_block, last_block = child.block] {
      for (const auto& some : links) {
        for (const Link& link : some) {
          if (link.old.block < first_block || link.old.block > last_block) continue;
          triangulation_.blocks[link.old.block].set_neighbour(link.old, link.old_place,
                                                              link.created);
        }
      }
    });
    first_block = child.block + 1;
  }
  group.wait();

  parallel_for(border_.size(), kGrain, [&](std::size_t, std::size_t begin, std::size_t end) {
    for (std::size_t b = begin; b < end; ++b) {
      Mark& mark = marks_[border_[b].block][border_[b].index];
      if (mark == Mark::kBorder) {
        triangulation_.blocks[border_[b].block].simplices[border_[b].index].vertices[0] = kNoVertex;
      }
      mark = Mark::kInterior;
    }
  });
}

template <int D>
PartSurface Merge<D>::surface() {
  PartSurface surface;
  surface.dimension = border_mesh_.dimension;
  surface.open = surface.dimension < D;
  if (surface.open) {
    surface.vertices = std::move(border_vertices_);
    return surface;
  }
  for (const PartSurface& child : children_) {
    std::copy_if(child.hull.begin(), child.hull.end(), std::back_inserter(surface.hull),
                 [&](SimplexId id) { return !triangulation_.simplex(id).removed(); });
  }
  const auto& simplices = new_block().simplices;
  for (std::uint32_t i = 0; i < simplices.size(); ++i) {
    if (simplices[i].infinite()) surface.hull.push_back({part_.block, i});
  }
  return surface;
}

}  // namespace

template <int D>
PartSurface merge(Triangulation<D>& triangulation, std::span<BlockMarks> marks, const Part<D>& part,
                  std::span<PartSurface> children, bool may_stay_open,
                  const BorderTriangulator<D>& triangulate_border, Task& task) {
  task.after.reserve(4);
  Merge<D> merge(triangulation, marks, part, children);
  merge.find_borders(task.after.emplace_back());
  if (may_stay_open && merge.border_share() > kLargestBorder) {
    PartSurface open;
    open.dimension = D;
    return open;
  }
  task.after.resize(4);
  merge.triangulate_border(triangulate_border, task.after[1]);
  merge.accept(task.after[2]);
  merge.link(task.after[3]);
  return merge.surface();
}

template PartSurface merge<2>(Triangulation<2>&, std::span<BlockMarks>, const Part<2>&,
                              std::span<PartSurface>, bool, const BorderTriangulator<2>&, Task&);
template PartSurface merge<3>(Triangulation<3>&, std::span<BlockMarks>, const Part<3>&,
                              std::span<PartSurface>, bool, const BorderTriangulator<3>&, Task&);

}  // namespace spillway
