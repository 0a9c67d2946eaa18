// Whether the boundary of a mesh is one convex surface, traversed once. Letters B1 to B4 are those
// of docs/algorithm-checker.md.

#include <algorithm>

#include "src/geometry/dimensions.h"
#include "src/geometry/predicates.h"
#include "stream/checker/mesh_proof.h"

namespace spillway::checker {
namespace {

template <int D>
class BoundaryProof {
 public:
  BoundaryProof(const MeshView<D>& mesh, const std::vector<BoundaryFacet<D>>& boundary,
                Faults& faults)
      : mesh_(mesh), boundary_(boundary), faults_(faults) {}

  void run() {
    const std::uint64_t before = faults_.count();
    check_ridges();
    if (faults_.count() > before) return;  // what follows would say the same of many more facets
    check_common_inside();
    check_single_cover();
  }

 private:
  // B1 and B2: two facets meet at every ridge, at a convex or straight angle.
  void check_ridges() {
    std::vector<Face<D - 1>> ridges;
    ridges.reserve(boundary_.size() * D);
    for (std::size_t f = 0; f < boundary_.size(); ++f) {
      for (int i = 0; i < D; ++i) {
        Face<D - 1> ridge{{}, f * D + i};
        for (int j = 0, k = 0; j < D; ++j) {
          if (j != i) ridge.vertices[k++] = boundary_[f].vertices[j];
        }
        std::sort(ridge.vertices.begin(), ridge.vertices.end());
        ridges.push_back(ridge);
      }
    }
    for_each_run(ridges, [this](const Face<D - 1>* ridge, std::size_t count) {
      if (count != 2) {
        faults_.add("{} is in {} {}s of the boundary instead of 2", ridge_text(*ridge), count,
                    Words<D>::kFacet);
        return;
      }
      const auto& facet = boundary_[ridge[0].owner / D];
      const std::uint64_t apex = boundary_[ridge[1].owner / D].vertices[ridge[1].owner % D];
      if (orientation<D>(mesh_.simplex(facet.vertices, apex)) > 0) {
        faults_.add("the boundary is not convex at {}: {} lies beyond {}", ridge_text(*ridge),
                    mesh_.vertex_text(apex), facet_text(facet));
      }
    });
  }

  // B3: the inside of one simplex lies on the inner side of every facet.
  void check_common_inside() {
    const std::uint64_t base = boundary_[0].simplex;
    for (const auto& facet : boundary_) {
      int highest = -1;
      int lowest = 1;
      for (int i = 0; i <= D; ++i) {
        const int side = orientation<D>(mesh_.simplex(facet.vertices, mesh_.corner(base, i)));
        highest = std::max(highest, side);
        lowest = std::min(lowest, side);
      }
      if (highest > 0 || lowest == 0) {
        faults_.add("the boundary is not one convex surface: {} does not lie inside {}",
                    mesh_.simplex_text(base), facet_text(facet));
      }
    }
  }

  // B4: nothing lies beyond the first facet, and nothing covers it a second time.
  void check_single_cover() {
    const auto& first = boundary_[0];
    for (const auto& facet : boundary_) {
      if (&facet == &first) continue;
      bool coplanar = true;
      for (const std::uint64_t vertex : facet.vertices) {
        const int side = orientation<D>(mesh_.simplex(first.vertices, vertex));
        coplanar = coplanar && side == 0;
        if (side > 0) {
          faults_.add("the boundary is not one convex surface: {} lies beyond {}",
                      mesh_.vertex_text(vertex), facet_text(first));
        }
      }
      if (coplanar && covers_first(facet)) {
        faults_.add("the boundary covers itself: {} overlaps {}", facet_text(facet),
                    facet_text(first));
      }
    }
  }

  // Whether a facet in the plane of the first one covers it next to its first vertex: at v0 +
  // e1 (v1 - v0) + e2 (v2 - v0) + ..., where each e is tiny beside the one before. On which side of
  // a ridge that point is, the first vertex tells that is not on the ridge itself. A point is on
  // the inner side of the i-th ridge if putting it in place of the facet's i-th vertex keeps the
  // orientation of the simplex that the facet forms with a point off the plane.
  bool covers_first(const BoundaryFacet<D>& facet) const {
    const std::uint64_t off = apex_of(facet);
    const int inner = orientation<D>(mesh_.simplex(facet.vertices, off));
    for (int i = 0; i < D; ++i) {
      int side = 0;
      for (int v = 0; v < D && side == 0; ++v) {
        auto replaced = facet.vertices;
        replaced[i] = boundary_[0].vertices[v];
        side = orientation<D>(mesh_.simplex(replaced, off)) * inner;
      }
      if (side < 0) return false;
    }
    return true;
  }

  // The vertex of the facet's simplex that the facet does not have.
  [[nodiscard]] std::uint64_t apex_of(const BoundaryFacet<D>& facet) const {
    int i = 0;
    while (std::find(facet.vertices.begin(), facet.vertices.end(),
                     mesh_.corner(facet.simplex, i)) != facet.vertices.end()) {
      ++i;
    }
    return mesh_.corner(facet.simplex, i);
  }

  [[nodiscard]] std::string ridge_text(const Face<D - 1>& ridge) const {
    return mesh_.face_text(Words<D>::kRidge, ridge.vertices);
  }
  [[nodiscard]] std::string facet_text(const BoundaryFacet<D>& facet) const {
    return fmt::format("boundary {} of {}", mesh_.face_text(Words<D>::kFacet, facet.vertices),
                       mesh_.simplex_text(facet.simplex));
  }

  const MeshView<D>& mesh_;
  const std::vector<BoundaryFacet<D>>& boundary_;
  Faults& faults_;
};

}  // namespace

template <int D>
void prove_boundary(const MeshView<D>& mesh, const std::vector<BoundaryFacet<D>>& boundary,
                    Faults& faults) {
  BoundaryProof<D>(mesh, boundary, faults).run();
}

#define SPILLWAY_INSTANTIATE(D)                                                             \
  template void prove_boundary<D>(const MeshView<D>&, const std::vector<BoundaryFacet<D>>&, \
                                  Faults&);
SPILLWAY_FOR_EACH_DIMENSION(SPILLWAY_INSTANTIATE)
#undef SPILLWAY_INSTANTIATE

}  // namespace spillway::checker
