#include "src/distributed/view_builder.h"

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "src/delaunay/common/hash.h"
#include "src/error.h"

namespace spillway::detail::distributed {
namespace {

std::uint64_t key(RankIndex name) { return (std::uint64_t{name.rank} << 32U) | name.index; }

void check_limit(std::size_t count, std::size_t limit, const char* what) {
  if (count >= limit) {
    throw Error("one rank's view of the triangulation has " + std::to_string(count) + ' ' + what +
                    ", more than it can number: use more ranks",
                ErrorCode::kTooLarge);
  }
}

}  // namespace

template <int D>
BoxTree<D> tree_of_boxes(std::span<const Box<D>> boxes) {
  if (boxes.size() == 1) return {boxes.front(), {}};
  BoxTree<D> tree;
  tree.children.push_back(tree_of_boxes<D>(boxes.first(boxes.size() / 2)));
  tree.children.push_back(tree_of_boxes<D>(boxes.subspan(boxes.size() / 2)));
  for (const BoxTree<D>& child : tree.children) tree.box.expand(child.box);
  return tree;
}

template <int D>
ViewBuilder<D>::ViewBuilder(int rank, const Triangulation<D>& triangulation,
                            std::span<const NamedPoint<D>> points)
    : rank_(rank) {
  view.dimension = triangulation.dimension;
  std::vector<VertexId> renumbered(triangulation.points.size());
  auto duplicate = triangulation.duplicates.begin();
  const auto origin = [&](VertexId v) { return points[triangulation.input_index[v]].name; };
  for (VertexId v = 0; v < renumbered.size(); ++v) {
    if (duplicate != triangulation.duplicates.end() && duplicate->dropped == v) {
      view.duplicates.push_back({origin(v), origin(duplicate->kept)});
      ++duplicate;
      continue;
    }
    renumbered[v] = static_cast<VertexId>(view.points.size());
    view.names.push_back({static_cast<std::uint32_t>(rank), renumbered[v]});
    view.points.push_back(triangulation.points[v]);
    view.origins.push_back(origin(v));
  }
  view.own = view.points.size();
  std::sort(view.duplicates.begin(), view.duplicates.end(),
            [](const auto& a, const auto& b) { return a.dropped < b.dropped; });

  std::vector<std::size_t> first_of_list;
  std::size_t total = 0;
  for (const SimplexList<D>& list : triangulation.lists) {
    first_of_list.push_back(total);
    total += list.simplices.size();
  }
  check_limit(total, View<D>::kLimit, "simplices");
  check_limit(view.own, View<D>::kLimit, "vertices");
  const auto flat = [&](SimplexId id) {
    return static_cast<std::uint32_t>(first_of_list[id.list] + id.index);
  };
  Simplex<D> removed{};
  removed.vertices[0] = kNoVertex;
  view.simplices.assign(total, removed);
  triangulation.for_each_simplex([&](SimplexId id, const Simplex<D>& simplex) {
    Simplex<D>& copy = view.simplices[flat(id)];
    for (int i = 0; i <= D; ++i) {
      const VertexId v = simplex.vertices[i];
      copy.vertices[i] = v == kInfiniteVertex ? v : renumbered[v];
      copy.neighbours[i] = flat(triangulation.neighbour(id, i));
    }
  });
  for (const SimplexId id : triangulation.hull) surface_.push_back(flat(id));
}

template <int D>
VertexId ViewBuilder<D>::vertex_named(RankIndex name) const {
  if (name == kInfiniteName) return kInfiniteVertex;
  if (name.rank == static_cast<std::uint32_t>(rank_)) return name.index;
  const auto found = foreign_.find(key(name));
  if (found == foreign_.end()) {
    throw std::logic_error("merge of views: a vertex of another rank without a position");
  }
  return found->second;
}

template <int D>
VertexId ViewBuilder<D>::add_vertex(const NamedPoint<D>& point) {
  if (point.name == kInfiniteName) return kInfiniteVertex;
  if (point.name.rank == static_cast<std::uint32_t>(rank_)) return point.name.index;
  const auto [entry, added] =
      foreign_.emplace(key(point.name), static_cast<VertexId>(view.points.size()));
  if (added) {
    view.points.push_back(point.position);
    view.names.push_back(point.name);
    check_limit(view.points.size(), View<D>::kLimit, "vertices");
  }
  return entry->second;
}

template <int D>
std::vector<RankIndex> ViewBuilder<D>::find_border(const BoxTree<D>& others) {
  marks_.assign(view.simplices.size(), Mark::kInterior);
  border_.clear();
  std::vector<std::uint32_t> candidates = surface_;
  std::vector<RankIndex> names;
  while (!candidates.empty()) {
    const std::uint32_t s = candidates.back();
    candidates.pop_back();
    if (marks_[s] != Mark::kInterior) continue;
    const Simplex<D>& simplex = view.simplices[s];
    if (!ConflictRegion<D>(simplex.vertices, view.points).may_meet_leaf(others)) continue;
    marks_[s] = Mark::kBorder;
    border_.push_back(s);
    for (int i = 0; i <= D; ++i) {
      if (View<D>::local(simplex, i)) candidates.push_back(simplex.neighbours[i]);
      if (simplex.vertices[i] != kInfiniteVertex) names.push_back(name_of(simplex.vertices[i]));
    }
  }
  std::sort(names.begin(), names.end());
  names.erase(std::unique(names.begin(), names.end()), names.end());
  return names;
}

template <int D>
void ViewBuilder<D>::accept(const ItemsByRank<NamedSimplex<D>>& simplices,
                            const ItemsByRank<NamedPoint<D>>& points, int first_rank, int end_rank,
                            bool open) {
  for (const auto& [sender, some] : points) {
    for (const NamedPoint<D>& point : some) add_vertex(point);
  }
  ConcurrentIndex index(border_.size());
  for (std::uint32_t b = 0; b < border_.size(); ++b) {
    index.insert(simplex_hash(view.simplices[border_[b]].vertices), b);
  }
  first_new_ = static_cast<std::uint32_t>(view.simplices.size());
  for (const auto& [sender, some] : simplices) {
    for (const NamedSimplex<D>& named : some) {
      Simplex<D> simplex;
      simplex.neighbours.fill(SimplexList<D>::kUnlinked);
      bool spans = false;
      for (int i = 0; i <= D; ++i) {
        simplex.vertices[i] = vertex_named(named[i]);
        const auto owner = static_cast<int>(named[i].rank);
        spans = spans || (named[i] != kInfiniteName && (owner < first_rank || owner >= end_rank));
      }
      if (spans || open) {
        view.simplices.push_back(simplex);
        continue;
      }
      const std::uint32_t b = index.find(simplex_hash(simplex.vertices), [&](std::uint32_t item) {
        return same_simplex(simplex.vertices, view.simplices[border_[item]].vertices);
      });
      if (b != ConcurrentIndex::kNotFound) marks_[border_[b]] = Mark::kSurvivor;
    }
  }
  check_limit(view.simplices.size(), View<D>::kLimit, "simplices");
  marks_.resize(view.simplices.size(), Mark::kInterior);
}

template <int D>
auto ViewBuilder<D>::facet_of(std::uint32_t simplex, int corner) const -> OpenFacet {
  const Corners& corners = view.simplices[simplex].vertices;
  OpenFacet facet{{}, simplex, corner};
  std::copy(corners.begin(), corners.begin() + corner, facet.vertices.begin());
  std::copy(corners.begin() + corner + 1, corners.end(), facet.vertices.begin() + corner);
  std::sort(facet.vertices.begin(), facet.vertices.end());
  return facet;
}

template <int D>
bool ViewBuilder<D>::has_own_vertex(const Facet& facet) const {
  return is_own(facet.front());
}

/// Facets between what stays and what is removed, those of all that is new, and those without an
/// own vertex: whether there is something new beyond these is not to be seen here.
template <int D>
void ViewBuilder<D>::collect_open_facets() {
  open_facets_.clear();
  for (const std::uint32_t s : border_) {
    if (marks_[s] != Mark::kBorder) continue;
    const Simplex<D>& simplex = view.simplices[s];
    for (int i = 0; i <= D; ++i) {
      if (!View<D>::local(simplex, i)) continue;
      const std::uint32_t other = simplex.neighbours[i];
      if (marks_[other] == Mark::kBorder) continue;
      const auto& back = view.simplices[other].neighbours;
      const auto corner = std::find(back.begin(), back.end(), s) - back.begin();
      const OpenFacet facet = facet_of(other, static_cast<int>(corner));
      if (has_own_vertex(facet.vertices)) open_facets_.push_back(facet);
    }
  }
  for (const std::uint32_t s : surface_) {
    if (marks_[s] == Mark::kBorder) continue;
    for (int i = 0; i <= D; ++i) {
      const OpenFacet facet = facet_of(s, i);
      if (!has_own_vertex(facet.vertices)) open_facets_.push_back(facet);
    }
  }
  for (std::uint32_t s = first_new_; s < view.simplices.size(); ++s) {
    for (int i = 0; i <= D; ++i) open_facets_.push_back(facet_of(s, i));
  }
  std::sort(open_facets_.begin(), open_facets_.end());
}

template <int D>
ItemsByRank<NeighbourUpdate<D>> ViewBuilder<D>::link() {
  collect_open_facets();
  ItemsByRank<NeighbourUpdate<D>> updates;
  for (std::size_t f = 0; f + 1 < open_facets_.size(); ++f) {
    const OpenFacet& a = open_facets_[f];
    const OpenFacet& b = open_facets_[f + 1];
    if (a.vertices != b.vertices) continue;
    view.simplices[a.simplex].neighbours[a.corner] = b.simplex;
    view.simplices[b.simplex].neighbours[b.corner] = a.simplex;
    if (is_new(a.simplex) || is_new(b.simplex)) {
      tell(a, b, updates);
      tell(b, a, updates);
    }
  }
  for (const std::uint32_t s : border_) {
    if (marks_[s] == Mark::kBorder) view.simplices[s].vertices[0] = kNoVertex;
  }
  std::erase_if(surface_, [&](std::uint32_t s) { return is_removed(s); });
  for (std::uint32_t s = first_new_; s < view.simplices.size(); ++s) surface_.push_back(s);
  return updates;
}

/// Tells the owner of the first simplex's vertex opposite the facet of the second simplex, if that
/// owner cannot know of it and if it is this rank, of the facet's owners, that has to tell.
template <int D>
void ViewBuilder<D>::tell(const OpenFacet& facet, const OpenFacet& other,
                          ItemsByRank<NeighbourUpdate<D>>& updates) const {
  const RankIndex here = name_of(view.simplices[facet.simplex].vertices[facet.corner]);
  if (here == kInfiniteName) return;
  const VertexId beyond = view.simplices[other.simplex].vertices[other.corner];
  NeighbourUpdate<D> update{{}, here, {{}, name_of(beyond)}};
  if (update.beyond.name.rank == here.rank) return;
  if (beyond != kInfiniteVertex) update.beyond.position = view.points[beyond];
  for (int i = 0; i < D; ++i) {
    update.facet[i] = name_of(facet.vertices[i]);
    if (update.facet[i].rank == here.rank) return;
  }
  const RankIndex teller = *std::min_element(update.facet.begin(), update.facet.end());
  if (teller.rank != static_cast<std::uint32_t>(rank_)) return;
  updates[static_cast<int>(here.rank)].push_back(update);
}

template <int D>
void ViewBuilder<D>::apply(const ItemsByRank<NeighbourUpdate<D>>& updates) {
  for (const auto& [sender, some] : updates) {
    for (const NeighbourUpdate<D>& update : some) {
      OpenFacet facet{};
      for (int i = 0; i < D; ++i) facet.vertices[i] = vertex_named(update.facet[i]);
      std::sort(facet.vertices.begin(), facet.vertices.end());
      const auto found = std::lower_bound(open_facets_.begin(), open_facets_.end(), facet);
      if (found == open_facets_.end() || found->vertices != facet.vertices ||
          view.simplices[found->simplex].vertices[found->corner] != vertex_named(update.here)) {
        throw std::logic_error("merge of views: news of the neighbour of an unknown simplex");
      }
      view.simplices[found->simplex].neighbours[found->corner] =
          View<D>::elsewhere(add_vertex(update.beyond));
    }
  }
  check_linked();
}

template <int D>
void ViewBuilder<D>::check_linked() const {
  for (const OpenFacet& facet : open_facets_) {
    const Simplex<D>& simplex = view.simplices[facet.simplex];
    const std::uint32_t n = simplex.neighbours[facet.corner];
    if (n == SimplexList<D>::kUnlinked ||
        (View<D>::local(simplex, facet.corner) && is_removed(n))) {
      throw std::logic_error("merge of views: a simplex has no neighbour across one of its facets");
    }
  }
}

template <int D>
void ViewBuilder<D>::compact() {
  std::vector<std::uint32_t> simplex_number(view.simplices.size());
  std::vector<bool> used(view.points.size());
  std::uint32_t kept = 0;
  for (std::uint32_t s = 0; s < view.simplices.size(); ++s) {
    if (is_removed(s)) continue;
    simplex_number[s] = kept++;
    const Simplex<D>& simplex = view.simplices[s];
    for (int i = 0; i <= D; ++i) {
      if (simplex.vertices[i] != kInfiniteVertex) used[simplex.vertices[i]] = true;
      if (View<D>::local(simplex, i)) continue;
      const VertexId beyond = view.beyond(simplex, i);
      if (beyond != kInfiniteVertex) used[beyond] = true;
    }
  }

  std::vector<VertexId> vertex_number(view.points.size());
  auto vertices = static_cast<VertexId>(view.own);
  for (VertexId v = 0; v < view.points.size(); ++v) {
    if (!is_own(v) && !used[v]) continue;
    vertex_number[v] = is_own(v) ? v : vertices++;
    view.points[vertex_number[v]] = view.points[v];
    view.names[vertex_number[v]] = view.names[v];
  }
  view.points.resize(vertices);
  view.names.resize(vertices);

  const auto renumber = [&](VertexId v) { return v == kInfiniteVertex ? v : vertex_number[v]; };
  for (Simplex<D>& simplex : view.simplices) {
    if (simplex.removed()) continue;
    for (int i = 0; i <= D; ++i) {
      std::uint32_t& n = simplex.neighbours[i];
      n = View<D>::local(simplex, i) ? simplex_number[n]
                                     : View<D>::elsewhere(renumber(view.beyond(simplex, i)));
    }
    for (VertexId& v : simplex.vertices) v = renumber(v);
  }
  std::erase_if(view.simplices, [](const Simplex<D>& simplex) { return simplex.removed(); });
}

template BoxTree<2> tree_of_boxes<2>(std::span<const Box<2>>);
template BoxTree<3> tree_of_boxes<3>(std::span<const Box<3>>);
template class ViewBuilder<2>;
template class ViewBuilder<3>;

}  // namespace spillway::detail::distributed
