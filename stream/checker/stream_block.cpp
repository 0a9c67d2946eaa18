#include "stream/checker/stream_block.h"

#include <cmath>
#include <utility>

#include "src/error.h"
#include "src/geometry/canonical_hash.h"
#include "src/geometry/determinants.h"
#include "src/geometry/dimensions.h"
#include "src/geometry/predicates.h"
#include "stream/checker/mesh_proof.h"

namespace spillway::checker {

namespace {

/// Times D!, rounded.
template <int D>
double volume_of(const std::array<Point<D>, D + 1>& corners) {
  Vectors<D, D, double> edges;
  for (int i = 0; i < D; ++i) {
    for (int k = 0; k < D; ++k) edges[i][k] = corners[i + 1][k] - corners[0][k];
  }
  return std::abs(orientation_determinant<D>(edges));
}

}  // namespace

template <int D>
void StreamBlock<D>::examine(const StreamCoordinates<D>& coordinates, const CheckerOptions& options,
                             StreamTask task) {
  if (block.corners.size() >= kMatched || block.corners.size() % (D + 1) != 0) {
    const bool too_many = block.corners.size() >= kMatched;
    throw Failure(
        fmt::format(
            "a block of the mesh stream lists {} corners, which {}", block.corners.size(),
            too_many ? "are more than can be checked" : "make no whole number of simplices"),
        too_many ? ErrorCode::kTooLarge : ErrorCode::kBadInput);
  }
  found = {};
  examine_simplices(coordinates, options, task);
  match_facets(coordinates, options, task);
}

template <int D>
void StreamBlock<D>::examine_simplices(const StreamCoordinates<D>& coordinates,
                                       const CheckerOptions& options, StreamTask task) {
  hashes_.resize(points.size());
  for (std::size_t v = 0; v < points.size(); ++v) {
    hashes_[v] = vertex_hash<D>(coordinates.to_output(points[v]));
  }
  CanonicalHash<D> hash;
  hash.add(block.corners, hashes_);
  canonical_hash = hash.value();
  used.assign(points.size(), false);
  positive.assign(simplices(), true);
  not_positive = 0;
  volume = 0;
  Faults faults(found, options.most_faults);
  for (std::size_t s = 0; s < positive.size(); ++s) {
    for (int i = 0; i <= D; ++i) used[block.corners[s * (D + 1) + i]] = true;
    if (task == StreamTask::kCount) continue;
    const std::array<Point<D>, D + 1> corners = simplex(s, coordinates);
    if (coordinates.torus()) volume += volume_of<D>(corners);
    const int o = orientation<D>(corners);
    if (o > 0) continue;
    positive[s] = false;
    ++not_positive;
    faults.add("{} is {}", text(s, coordinates),
               o < 0 ? "negatively oriented" : "degenerate: it has no volume");
  }
}

// Every facet first looks for its like among the open ones with the same smallest vertex, which are
// very few, as a simplex's neighbours mostly come soon after it.
template <int D>
void StreamBlock<D>::match_facets(const StreamCoordinates<D>& coordinates,
                                  const CheckerOptions& options, StreamTask task) {
  inner_facets = 0;
  not_delaunay = 0;
  heads_.assign(points.size(), kNone);
  links_.resize(first_across());
  Faults faults(found, options.most_faults);
  std::uint64_t last_twin = simplices();
  for (std::uint32_t f = 0; f < links_.size(); ++f) {
    const SortedFacet<D> facet(&block.corners[f - f % (D + 1)], static_cast<int>(f % (D + 1)));
    Link& link = links_[f];
    std::copy_n(facet.vertices.begin() + 1, D - 1, link.rest.begin());
    std::uint32_t& head = heads_[facet.vertices[0]];
    std::uint32_t* at = &head;
    while (*at != kNone && !same_numbers(links_[*at].rest, link.rest)) at = &links_[*at].next;
    if (*at == kNone) {
      link.next = head;
      head = f;
      continue;
    }
    const std::uint32_t older = *at;
    link.next = kMatched;
    if (task == StreamTask::kProve && block.corners[older] == block.corners[f]) {
      // The older one stays, as if it were alone.
      if (last_twin != f / (D + 1)) {
        faults.add("{} has the same vertices as {} {}", text(f / (D + 1), coordinates),
                   Words<D>::kSimplex, first_simplex + older / (D + 1));
      }
      last_twin = f / (D + 1);
      continue;
    }
    *at = links_[older].next;
    links_[older].next = kMatched;
    if (task == StreamTask::kCount) continue;
    const SortedFacet<D> other(&block.corners[older - older % (D + 1)],
                               static_cast<int>(older % (D + 1)));
    prove_facet(older, f, facet.odd != other.odd, coordinates, faults, options);
  }
  open.clear();
  for (std::uint32_t f = 0; f < links_.size(); ++f) {
    if (links_[f].next != kMatched) open.push_back(f);
  }
  for (std::size_t f = first_across(); f < block.corners.size(); ++f) {
    open.push_back(static_cast<std::uint32_t>(f));
  }
}

template <int D>
void StreamBlock<D>::prove_facet(std::uint32_t older, std::uint32_t newer, bool two_sides,
                                 const StreamCoordinates<D>& coordinates, Faults& faults,
                                 const CheckerOptions& options) {
  const std::size_t a = newer / (D + 1);
  const std::size_t b = older / (D + 1);
  if (!positive[a] || !positive[b]) return;
  if (!two_sides) {
    faults.add("{} and {} overlap: they lie on the same side of their common {}",
               text(b, coordinates), text(a, coordinates), Words<D>::kFacet);
    return;
  }
  ++inner_facets;
  const std::uint32_t apex = block.corners[older];
  const ApexSide side = apex_side<D>(simplex(a, coordinates), points[apex], options);
  if (side == ApexSide::kOutside) return;
  ++not_delaunay;
  faults.add_apex(side, text(a, coordinates), vertex_text<D>(named(apex, coordinates)),
                  text(b, coordinates));
}

#define SPILLWAY_INSTANTIATE(D) template class StreamBlock<D>;
SPILLWAY_FOR_EACH_DIMENSION(SPILLWAY_INSTANTIATE)
#undef SPILLWAY_INSTANTIATE

}  // namespace spillway::checker
