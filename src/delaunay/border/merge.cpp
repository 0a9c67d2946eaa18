#include "src/delaunay/border/merge.h"

#include <algorithm>
#include <array>
#include <numeric>
#include <stdexcept>
#include <string>
#include <utility>

#include "src/delaunay/border/acceptance.h"
#include "src/delaunay/common/hash.h"
#include "src/delaunay/common/schedule.h"
#include "src/error.h"
#include "src/geometry/dimensions.h"
#include "src/parallel/parallel.h"

namespace spillway::delaunay {
namespace {

constexpr std::size_t kGrain = 4096;

/// Of a leaf the candidates for its border are tested one by one if they are at most this part of
/// its simplices; otherwise the border is searched for.
constexpr std::size_t kFewCandidates = 4;

/// The vertices of a simplex without the i-th.
template <std::size_t N>
std::array<VertexId, N - 1> facet_vertices(const std::array<VertexId, N>& vertices, int i) {
  std::array<VertexId, N - 1> facet;
  std::copy(vertices.begin(), vertices.begin() + i, facet.begin());
  std::copy(vertices.begin() + i + 1, vertices.end(), facet.begin() + i);
  return facet;
}

/// The corner of `a` that its neighbour `b` does not have. Without branches.
template <std::size_t N>
int opposite_corner(const std::array<VertexId, N>& a, const std::array<VertexId, N>& b) {
  int corner = 0;
  for (std::size_t i = 1; i < N; ++i) {
    bool shared = false;
    for (const VertexId v : b) shared |= a[i] == v;
    corner = shared ? corner : static_cast<int>(i);
  }
  return corner;
}

/// One merge. The steps are called in the order in which they stand here.
template <int D>
class Merge {
 public:
  Merge(Triangulation<D>& triangulation, std::span<ListMarks> marks,
        std::span<const RunBoxes<D>> boxes, const Part<D>& part, std::span<PartSurface> children)
      : triangulation_(triangulation),
        marks_(marks),
        boxes_(boxes),
        part_(part),
        children_(children) {}

  /// Step 1: border_ and border_vertices_.
  void find_borders(Task& task);

  /// The share of the part's points that are in borders.
  [[nodiscard]] double border_share() const {
    return static_cast<double>(border_vertices_.size()) / static_cast<double>(part_.size());
  }

  /// Step 2: border_mesh_.
  void triangulate_border(const BorderTriangulator<D>& triangulate, Task& task);

  /// Step 3: targets_, the new list's vertices, survived_, new_hull_. Renumbers border_mesh_.
  void accept(Task& task);

  /// Step 4: neighbours of the new simplices and back; removes what did not survive.
  void link(Task& task);

  PartSurface surface();

 private:
  using Vertices = std::array<VertexId, D + 1>;
  using Questions = typename Acceptance<D>::template Questions<SimplexId*>;

  /// A facet between a simplex of the border that is removed and one outside of the border.
  struct UnpairedFacet {
    std::uint32_t removed;  ///< number in border_
    int corner;             ///< of the removed simplex's vertex opposite the facet
    SimplexId outside;
  };
  /// Two simplices that become neighbours: a new one, and one of a child.
  struct Link {
    SimplexId created;
    int created_corner;
    SimplexId old;
  };

  SimplexList<D>& new_list() { return triangulation_.lists[part_.list]; }
  [[nodiscard]] bool created(SimplexId target) const { return target.list == part_.list; }
  [[nodiscard]] std::size_t flat(SimplexId id) const { return first_of_list_[id.list] + id.index; }

  void join(const std::vector<std::vector<SimplexId>>& borders);
  [[nodiscard]] static std::vector<VertexId> vertices_of(std::span<const Vertices> simplices,
                                                         const Part<D>& child);
  template <typename Body>
  void for_mesh_simplices(std::size_t begin, std::size_t end, const Body& body) const;
  std::uint32_t accept_grain(std::size_t begin, std::size_t end, Questions questions);
  [[nodiscard]] std::vector<UnpairedFacet> open_facets();
  void link_simplex(SimplexId in_border_mesh, SimplexId created, const ConcurrentIndex& facet_index,
                    const std::vector<UnpairedFacet>& facets, std::vector<Link>& links);
  void link_new_list(const std::vector<std::vector<Link>>& links);
  void link_children(const std::vector<std::vector<Link>>& links, Task& task);

  Triangulation<D>& triangulation_;
  std::span<ListMarks> marks_;
  std::span<const RunBoxes<D>> boxes_;  ///< of leaves, by list
  const Part<D>& part_;
  std::span<PartSurface> children_;

  std::vector<SimplexId> border_;          ///< of all children
  SlabArray<Vertices> border_corners_;     ///< its simplices' vertices
  std::vector<std::uint8_t> survived_;     ///< whether border_mesh_ has them, too
  std::vector<VertexId> border_vertices_;  ///< sorted
  Triangulation<D> border_mesh_;
  std::vector<VertexId> renumbered_;        ///< of border_mesh_, to vertices of triangulation_
  std::vector<std::size_t> first_of_list_;  ///< flat number of each list's first simplex
  /// By flat number in border_mesh_: the simplex of triangulation_ that it is or becomes, or
  /// kNoSimplex if it is dropped.
  std::vector<SimplexId> targets_;
  std::vector<SimplexId> new_hull_;  ///< infinite simplices of the new list
};

template <int D>
void Merge<D>::find_borders(Task& task) {
  task.kind = TaskKind::kBorder;
  const Stopwatch watch(task.seconds);
  const std::size_t count = children_.size();
  std::vector<std::vector<SimplexId>> borders(count);
  TaskGroup group;
  for (std::size_t c = 0; c < count; ++c) {
    group.run([&, c] {
      if (children_[c].open) return;
      std::vector<const Part<D>*> others;
      for (std::size_t o = 0; o < count; ++o) {
        if (o != c) others.push_back(&part_.children[o]);
      }
      const Part<D>& child = part_.children[c];
      Siblings<D> siblings{others, triangulation_.points.span(), boxes_};
      if (!asking_for_points_pays<D>(triangulation_, child, siblings)) siblings.most_boxes = 0;
      const std::size_t size = triangulation_.lists[child.list].simplices.size();
      const auto& changeable = children_[c].changeable;
      borders[c] =
          changeable && changeable->size() <= size / kFewCandidates
              ? border_among<D>(triangulation_, child.list, *changeable, siblings, marks_)
              : find_border<D>(triangulation_, child.box, children_[c].hull, siblings, marks_);
    });
  }
  group.wait();
  join(borders);
  task.points = border_vertices_.size();
  task.grains = std::max<std::size_t>(1, grain_count(border_.size(), kGrain));
}

/// Sets border_, border_corners_ and border_vertices_ from the children's borders.
template <int D>
void Merge<D>::join(const std::vector<std::vector<SimplexId>>& borders) {
  std::size_t total = 0;
  for (const auto& some : borders) total += some.size();
  border_.resize(total);
  border_corners_ = SlabArray<Vertices>(total);
  std::vector<std::vector<VertexId>> vertices(borders.size());
  std::size_t begin = 0;
  TaskGroup group;
  for (std::size_t c = 0; c < borders.size(); ++c) {
    group.run([&, c, begin] {
      const std::size_t size = borders[c].size();
      std::copy(borders[c].begin(), borders[c].end(), border_.begin() + begin);
      for (std::size_t b = begin; b < begin + size; ++b) {
        border_corners_[b] = triangulation_.simplex(border_[b]).vertices;
      }
      vertices[c] = children_[c].open ? children_[c].vertices
                                      : vertices_of(std::span(border_corners_).subspan(begin, size),
                                                    part_.children[c]);
    });
    begin += borders[c].size();
  }
  group.wait();
  for (const auto& some : vertices) {
    border_vertices_.insert(border_vertices_.end(), some.begin(), some.end());
  }
}

/// The finite vertices of a child's simplices, sorted.
template <int D>
std::vector<VertexId> Merge<D>::vertices_of(std::span<const Vertices> simplices,
                                            const Part<D>& child) {
  std::vector<bool> seen(child.size());
  for (const Vertices& corners : simplices) {
    for (const VertexId v : corners) {
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
  SlabArray<Point<D>> points(border_vertices_.size());
  std::transform(border_vertices_.begin(), border_vertices_.end(), points.begin(),
                 [&](VertexId v) { return triangulation_.points[v]; });
  border_mesh_ = triangulate(std::move(points), part_.size(), task);
}

/// Calls body(number, id) for the simplices of border_mesh_ of these flat numbers.
template <int D>
template <typename Body>
void Merge<D>::for_mesh_simplices(std::size_t begin, std::size_t end, const Body& body) const {
  const auto after = std::upper_bound(first_of_list_.begin(), first_of_list_.end(), begin);
  auto list = static_cast<std::uint32_t>(after - first_of_list_.begin() - 1);
  for (std::size_t number = begin; number < end; ++list) {
    const auto& simplices = border_mesh_.lists[list].simplices;
    const std::size_t first = first_of_list_[list];
    for (; number < std::min(end, first + simplices.size()); ++number) {
      const auto index = static_cast<std::uint32_t>(number - first);
      if (!simplices[index].removed()) body(number, SimplexId{list, index});
    }
  }
}

/// Sets the targets of mesh simplices. New ones are numbered from 0 on; returns their number.
template <int D>
std::uint32_t Merge<D>::accept_grain(std::size_t begin, std::size_t end, Questions questions) {
  const auto found = [this](const Vertices&, SimplexId* target, std::uint32_t number) {
    *target = border_[number];
    survived_[number] = 1;
  };
  std::uint32_t created = 0;
  for_mesh_simplices(begin, end, [&](std::size_t number, SimplexId id) {
    Vertices& simplex = border_mesh_.lists[id.list].simplices[id.index].vertices;
    for (VertexId& v : simplex) {
      if (v != kInfiniteVertex) v = renumbered_[v];
    }
    SimplexId& target = targets_[number];
    if (questions.is_new(simplex, &target, found)) target = {part_.list, created++};
  });
  questions.answer(found);
  return created;
}

template <int D>
void Merge<D>::accept(Task& task) {
  task.kind = TaskKind::kAccept;
  task.points = border_vertices_.size();
  const Stopwatch watch(task.seconds);

  renumbered_.resize(border_mesh_.input_index.size());
  std::transform(border_mesh_.input_index.begin(), border_mesh_.input_index.end(),
                 renumbered_.begin(), [&](VertexId v) { return border_vertices_[v]; });
  std::size_t total = 0;
  for (const SimplexList<D>& list : border_mesh_.lists) {
    first_of_list_.push_back(total);
    total += list.simplices.size();
  }
  task.grains = std::max<std::size_t>(1, grain_count(total, kGrain));
  targets_.assign(total, kNoSimplex);
  survived_.assign(border_.size(), 0);

  std::vector<VertexId> ends;
  std::vector<bool> open;
  for (const Part<D>& child : part_.children) ends.push_back(child.end);
  for (const PartSurface& child : children_) open.push_back(child.open);
  const Acceptance<D> acceptance(ends, std::move(open), border_corners_);
  std::vector<std::size_t> first_created(grain_count(total, kGrain) + 1);
  parallel_for(total, kGrain, [&](std::size_t g, std::size_t begin, std::size_t end) {
    first_created[g + 1] = accept_grain(begin, end, Questions(acceptance));
  });
  std::partial_sum(first_created.begin(), first_created.end(), first_created.begin());
  const std::size_t created_count = first_created.back();
  if (created_count >= Simplex<D>::kLink || border_.size() >= Simplex<D>::kLink) {
    throw Failure("the border of " + std::to_string(border_vertices_.size()) +
                      " points has more simplices than fit into one block",
                  ErrorCode::kTooLarge);
  }

  new_list().simplices = SlabArray<Simplex<D>>(created_count);
  marks_[part_.list] = ListMarks(created_count, Mark::kInterior);
  std::vector<std::vector<SimplexId>> hulls(grain_count(total, kGrain));
  parallel_for(total, kGrain, [&](std::size_t g, std::size_t begin, std::size_t end) {
    for_mesh_simplices(begin, end, [&](std::size_t number, SimplexId id) {
      SimplexId& target = targets_[number];
      if (!created(target)) return;
      target.index += static_cast<std::uint32_t>(first_created[g]);
      Simplex<D>& simplex = new_list().simplices[target.index];
      simplex.vertices = border_mesh_.simplex(id).vertices;
      if (simplex.infinite()) hulls[g].push_back(target);
    });
  });
  for (const auto& some : hulls) new_hull_.insert(new_hull_.end(), some.begin(), some.end());
}

template <int D>
auto Merge<D>::open_facets() -> std::vector<UnpairedFacet> {
  std::vector<std::vector<UnpairedFacet>> found(grain_count(border_.size(), kGrain));
  parallel_for(border_.size(), kGrain, [&](std::size_t g, std::size_t begin, std::size_t end) {
    for (std::size_t b = begin; b < end; ++b) {
      if (survived_[b] != 0) continue;
      for (int i = 0; i <= D; ++i) {
        const SimplexId other = triangulation_.neighbour(border_[b], i);
        if (marks_[other.list][other.index] != Mark::kBorder) {
          found[g].push_back({static_cast<std::uint32_t>(b), i, other});
        }
      }
    }
  });
  std::vector<UnpairedFacet> facets;
  for (const auto& some : found) facets.insert(facets.end(), some.begin(), some.end());
  return facets;
}

/// Sets the neighbours of a new simplex that are new too; collects the others as links.
template <int D>
void Merge<D>::link_simplex(SimplexId in_border_mesh, SimplexId created,
                            const ConcurrentIndex& facet_index,
                            const std::vector<UnpairedFacet>& facets, std::vector<Link>& links) {
  Simplex<D>& simplex = new_list().simplices[created.index];
  for (int i = 0; i <= D; ++i) {
    SimplexId other = targets_[flat(border_mesh_.neighbour(in_border_mesh, i))];
    if (other.list == part_.list) {
      simplex.neighbours[i] = other.index;
      continue;
    }
    if (other == kNoSimplex) {
      const SortedVertices<D> facet(facet_vertices(simplex.vertices, i));
      const std::uint32_t f =
          facet_index.find(facet_hash(simplex.vertices, i), [&](std::uint32_t item) {
            const UnpairedFacet& open = facets[item];
            const auto found = facet_vertices(border_corners_[open.removed], open.corner);
            return facet.vertices == SortedVertices<D>(found).vertices;
          });
      if (f == ConcurrentIndex::kNotFound) {
        throw std::logic_error("merge: a new simplex has no neighbour across one of its facets");
      }
      other = facets[f].outside;
    }
    links.push_back({created, i, other});
  }
}

template <int D>
void Merge<D>::link(Task& task) {
  task.kind = TaskKind::kNeighbours;
  task.points = border_vertices_.size();
  task.grains = std::max<std::size_t>(1, grain_count(targets_.size(), kGrain));
  std::vector<std::vector<Link>> links(grain_count(targets_.size(), kGrain));
  {
    const Stopwatch watch(task.seconds);
    const std::vector<UnpairedFacet> facets = open_facets();
    ConcurrentIndex facet_index(facets.size());
    parallel_for(facets.size(), kGrain, [&](std::size_t, std::size_t begin, std::size_t end) {
      for (std::size_t f = begin; f < end; ++f) {
        facet_index.insert(facet_hash(border_corners_[facets[f].removed], facets[f].corner),
                           static_cast<std::uint32_t>(f));
      }
    });
    parallel_for(targets_.size(), kGrain, [&](std::size_t g, std::size_t begin, std::size_t end) {
      for_mesh_simplices(begin, end, [&](std::size_t number, SimplexId id) {
        const SimplexId target = targets_[number];
        if (created(target)) link_simplex(id, target, facet_index, facets, links[g]);
      });
    });
    link_new_list(links);
    parallel_for(border_.size(), kGrain, [&](std::size_t, std::size_t begin, std::size_t end) {
      for (std::size_t b = begin; b < end; ++b) {
        const SimplexId id = border_[b];
        if (survived_[b] == 0) {
          triangulation_.lists[id.list].simplices[id.index].vertices[0] = kNoVertex;
        }
        marks_[id.list][id.index] = Mark::kInterior;
      }
    });
  }
  link_children(links, task.after.emplace_back());
}

/// Sets the neighbours of new simplices that are old ones.
template <int D>
void Merge<D>::link_new_list(const std::vector<std::vector<Link>>& links) {
  std::vector<std::size_t> first_link(links.size() + 1);
  for (std::size_t g = 0; g < links.size(); ++g)
    first_link[g + 1] = first_link[g] + links[g].size();
  SimplexList<D>& list = new_list();
  list.links.resize(first_link.back());
  parallel_for(links.size(), 1, [&](std::size_t g, std::size_t, std::size_t) {
    std::size_t number = first_link[g];
    for (const Link& link : links[g]) {
      list.links[number] = link.old;
      list.simplices[link.created.index].neighbours[link.created_corner] =
          Simplex<D>::kLink + static_cast<std::uint32_t>(number++);
    }
  });
}

/// Sets the neighbours of old simplices that are new ones. A list's links are one array, so each
/// child's lists are a task of their own.
template <int D>
void Merge<D>::link_children(const std::vector<std::vector<Link>>& links, Task& task) {
  task.kind = TaskKind::kNeighbours;
  task.points = border_vertices_.size();
  task.grains = part_.children.size();
  const Stopwatch watch(task.seconds);
  TaskGroup group;
  std::uint32_t first_list = 0;
  for (const Part<D>& child : part_.children) {
    group.run([&, first_list, last_list = child.list] {
      for (const auto& some : links) {
        for (const Link& link : some) {
          if (link.old.list < first_list || link.old.list > last_list) continue;
          SimplexList<D>& list = triangulation_.lists[link.old.list];
          const int corner = opposite_corner(list.simplices[link.old.index].vertices,
                                             new_list().simplices[link.created.index].vertices);
          list.set_neighbour(link.old, corner, link.created);
        }
      }
    });
    first_list = child.list + 1;
  }
  group.wait();
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
  surface.hull.insert(surface.hull.end(), new_hull_.begin(), new_hull_.end());
  return surface;
}

}  // namespace

template <int D>
PartSurface merge(Triangulation<D>& triangulation, std::span<ListMarks> marks,
                  std::span<const RunBoxes<D>> boxes, const Part<D>& part,
                  std::span<PartSurface> children, bool may_stay_open,
                  const BorderTriangulator<D>& triangulate_border, Task& task) {
  task.after.reserve(4);
  Merge<D> merge(triangulation, marks, boxes, part, children);
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

#define SPILLWAY_INSTANTIATE(D)                                                              \
  template PartSurface merge<D>(                                                             \
      Triangulation<D>&, std::span<ListMarks>, std::span<const RunBoxes<D>>, const Part<D>&, \
      std::span<PartSurface>, bool, const BorderTriangulator<D>&, Task&);
SPILLWAY_FOR_EACH_DIMENSION(SPILLWAY_INSTANTIATE)
#undef SPILLWAY_INSTANTIATE

}  // namespace spillway::delaunay
