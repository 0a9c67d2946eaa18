#include "stream/checker/mesh_proof.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "src/geometry/dimensions.h"
#include "src/geometry/predicates.h"

namespace spillway::checker {

template <int D>
NamedVertex<D> MeshView<D>::named(std::uint64_t vertex) const {
  return {numbers_ == nullptr ? vertex : numbers_->vertices[vertex], mesh_.vertex<D>(vertex)};
}

template <int D>
std::string MeshView<D>::simplex_text(std::uint64_t simplex) const {
  std::array<NamedVertex<D>, D + 1> vertices;
  for (int i = 0; i <= D; ++i) vertices[i] = named(corner(simplex, i));
  return spillway::checker::simplex_text<D>(
      numbers_ == nullptr ? simplex : numbers_->simplices[simplex], vertices);
}

template <int D>
ApexSide apex_side(const std::array<Point<D>, D + 1>& simplex, const Point<D>& apex,
                   const CheckerOptions& options) {
  const int side =
      options.any_delaunay ? side_of_sphere<D>(simplex, apex) : in_sphere<D>(simplex, apex);
  if (side <= 0) return ApexSide::kOutside;
  const bool tie = !options.any_delaunay && side_of_sphere<D>(simplex, apex) == 0;
  return tie ? ApexSide::kInsideByTie : ApexSide::kInside;
}

namespace {

template <int D>
class MeshProof {
 public:
  MeshProof(const Mesh& mesh, const CheckerOptions& options, CheckReport& report)
      : mesh_(mesh),
        options_(options),
        report_(report),
        faults_(report, options.most_faults),
        view_(mesh) {}

  void run() {
    if (!numbers_are_valid()) return;
    report_.canonical_hash = canonical_hash(mesh_);
    set_coordinates();
    check_vertices();
    check_orientations();
    if (!check_facets()) return;
    const std::uint64_t before = faults_.count();
    prove_boundary<D>(view_, boundary_, faults_);
    if (faults_.count() == before) {
      prove("the {} boundary {}s form one convex surface: the {} cover the hull exactly once",
            boundary_.size(), Words<D>::kFacet, Words<D>::kSimplices);
    }
  }

 private:
  template <typename... Args>
  void prove(fmt::format_string<Args...> format, Args&&... args) {
    report_.proved.push_back(fmt::format(format, std::forward<Args>(args)...));
  }

  // Whether the rest of the proof can be evaluated at all.
  bool numbers_are_valid() {
    const std::uint64_t before = faults_.count();
    if (mesh_.corners.empty()) faults_.add("the mesh has no {}", Words<D>::kSimplices);
    if (mesh_.corners.size() % (D + 1) != 0) {
      faults_.add("the mesh lists {} corners, which is no multiple of {}", mesh_.corners.size(),
                  D + 1);
    }
    for (std::size_t i = 0; i < mesh_.corners.size(); ++i) {
      if (mesh_.corners[i] >= mesh_.vertices.size()) {
        faults_.add("{} {} names vertex {}, but there are {} vertices", Words<D>::kSimplex,
                    i / (D + 1), mesh_.corners[i], mesh_.vertices.size());
      }
    }
    for (std::size_t v = 0; v < mesh_.vertices.size(); ++v) {
      for (const double coordinate : mesh_.vertex<D>(v)) {
        if (!std::isfinite(coordinate)) {
          faults_.add("{} has a coordinate that is not finite", view_.vertex_text(v));
        }
      }
    }
    return faults_.count() == before;
  }

  // The integers of the lattice where there is one with equal scales, else the coordinates as they
  // are.
  void set_coordinates() {
    std::optional<IntegerLattice> lattice =
        mesh_.header.lattice ? mesh_.header.lattice : options_.input_lattice;
    if (D > kOwnAxes) lattice.reset();  // coordinates beyond z are on none
    std::vector<Point<D>>& points = view_.points();
    const std::uint64_t before = faults_.count();
    if (lattice) {
      for (std::size_t v = 0; v < points.size(); ++v) {
        for (int k = 0; k < D; ++k) {
          const std::optional<double> integer = lattice->to_integer(k, mesh_.vertices[v][k]);
          if (integer) {
            points[v][k] = *integer;
          } else {
            ++report_.off_lattice;
            faults_.add("{} is off the lattice: its {} is no integer * {} + {}",
                        view_.vertex_text(v), "xyz"[k], lattice -> scale[k], lattice -> offset[k]);
          }
        }
      }
      if (faults_.count() == before) {
        prove("all {} vertices are on the lattice", points.size());
        report_.on_lattice = lattice->isotropic(D);
      }
    }
    if (report_.on_lattice) return;
    for (std::size_t v = 0; v < points.size(); ++v) points[v] = mesh_.vertex<D>(v);
  }

  // Every vertex used, no two of them equal.
  void check_vertices() {
    const std::uint64_t before = faults_.count();
    std::vector<bool> used(view_.vertex_count());
    for (const std::uint64_t corner : mesh_.corners) used[corner] = true;
    for (std::size_t v = 0; v < used.size(); ++v) {
      if (!used[v]) faults_.add("{} is in no {}", view_.vertex_text(v), Words<D>::kSimplex);
    }
    std::vector<std::pair<Point<D>, std::uint64_t>> sorted(view_.vertex_count());
    for (std::size_t v = 0; v < sorted.size(); ++v) sorted[v] = {view_.point(v), v};
    std::sort(sorted.begin(), sorted.end());
    for (std::size_t i = 1; i < sorted.size(); ++i) {
      if (sorted[i].first == sorted[i - 1].first) {
        faults_.add("{} and {} are the same point", view_.vertex_text(sorted[i - 1].second),
                    view_.vertex_text(sorted[i].second));
      }
    }
    if (faults_.count() == before) {
      prove("all {} vertices are used and distinct", view_.vertex_count());
    }
  }

  void check_orientations() {
    const std::uint64_t count = view_.simplex_count();
    positive_.resize(count);
    for (std::uint64_t s = 0; s < count; ++s) {
      const int o = orientation<D>(view_.simplex(s));
      positive_[s] = o > 0;
      if (o <= 0) {
        all_positive_ = false;
        faults_.add("{} is {}", view_.simplex_text(s),
                    o < 0 ? "negatively oriented" : "degenerate: it has no volume");
      }
    }
    if (all_positive_) prove("all {} {} are positively oriented", count, Words<D>::kSimplices);
  }

  // Every facet in two simplices on its two sides, or on the boundary; inner ones locally Delaunay.
  // Returns whether the boundary is that of positively oriented simplices, neatly matched.
  bool check_facets() {
    std::vector<Face<D>> facets(mesh_.corners.size());
    for (std::uint64_t owner = 0; owner < facets.size(); ++owner) {
      Face<D> facet{view_.facet(owner / (D + 1), static_cast<int>(owner % (D + 1))), owner};
      std::sort(facet.vertices.begin(), facet.vertices.end());
      facets[owner] = facet;
    }
    const std::uint64_t before = faults_.count();
    std::uint64_t inner = 0;
    std::uint64_t not_delaunay = 0;
    for_each_run(facets, [&](const Face<D>* facet, std::size_t count) {
      if (count == 1) {
        const std::uint64_t owner = facet->owner;
        boundary_.push_back(
            {view_.facet(owner / (D + 1), static_cast<int>(owner % (D + 1))), owner / (D + 1)});
      } else if (report_twins(facet, count)) {
        return;
      } else if (count > 2) {
        faults_.add("{} is in {} {}, among them {} and {}",
                    view_.face_text(Words<D>::kFacet, facet->vertices), count, Words<D>::kSimplices,
                    owner_text(facet[0]), owner_text(facet[1]));
      } else if (both_sides_covered(facet[0], facet[1])) {
        ++inner;
        if (!locally_delaunay(facet[0], facet[1])) ++not_delaunay;
      }
    });
    report_.hull_facets = boundary_.size();
    const bool matched = all_positive_ && faults_.count() - before == not_delaunay;
    if (!matched) return false;
    prove("every {} is in two {} or on the boundary", Words<D>::kFacet, Words<D>::kSimplices);
    if (not_delaunay == 0) {
      prove("all {} inner {}s are locally Delaunay{}{}", inner, Words<D>::kFacet,
            options_.any_delaunay ? "" : ", ties broken canonically",
            report_.on_lattice ? ", on the integers of the lattice" : "");
    }
    return true;
  }

  // Two simplices of a facet are twins if the vertices opposite to it are the same, too. They share
  // all their facets; the one opposite the largest vertex speaks for all.
  bool report_twins(const Face<D>* facet, std::size_t count) {
    bool found = false;
    for (std::size_t i = 1; i < count; ++i) {
      for (std::size_t j = 0; j < i; ++j) {
        const std::uint64_t apex = mesh_.corners[facet[i].owner];
        if (apex != mesh_.corners[facet[j].owner]) continue;
        found = true;
        if (apex >= facet->vertices[D - 1]) {
          faults_.add("{} has the same vertices as {} {}", owner_text(facet[i]), Words<D>::kSimplex,
                      facet[j].owner / (D + 1));
        }
      }
    }
    return found;
  }

  bool both_sides_covered(const Face<D>& a, const Face<D>& b) {
    if (!positive_[a.owner / (D + 1)] || !positive_[b.owner / (D + 1)]) return false;
    if (oddly_listed(a) != oddly_listed(b)) return true;
    faults_.add("{} and {} overlap: they lie on the same side of their common {}", owner_text(a),
                owner_text(b), Words<D>::kFacet);
    return false;
  }

  [[nodiscard]] std::string owner_text(const Face<D>& face) const {
    return view_.simplex_text(face.owner / (D + 1));
  }

  // Whether an odd number of swaps sorts the facet as its simplex lists it.
  [[nodiscard]] bool oddly_listed(const Face<D>& face) const {
    const auto listed = view_.facet(face.owner / (D + 1), static_cast<int>(face.owner % (D + 1)));
    bool odd = false;
    for (int i = 0; i < D; ++i) {
      for (int j = 0; j < i; ++j) odd ^= listed[j] > listed[i];
    }
    return odd;
  }

  bool locally_delaunay(const Face<D>& a, const Face<D>& b) {
    const std::uint64_t apex = mesh_.corners[b.owner];
    const ApexSide side =
        apex_side<D>(view_.simplex(a.owner / (D + 1)), view_.point(apex), options_);
    if (side == ApexSide::kOutside) return true;
    faults_.add_apex(side, owner_text(a), view_.vertex_text(apex), owner_text(b));
    return false;
  }

  const Mesh& mesh_;
  const CheckerOptions& options_;
  CheckReport& report_;
  Faults faults_;
  MeshView<D> view_;
  std::vector<bool> positive_;  // by simplex
  bool all_positive_ = true;
  std::vector<BoundaryFacet<D>> boundary_;
};

}  // namespace

template <int D>
void prove_mesh(const Mesh& mesh, const CheckerOptions& options, CheckReport& report) {
  MeshProof<D>(mesh, options, report).run();
}

#define SPILLWAY_INSTANTIATE(D)                                                       \
  template class MeshView<D>;                                                         \
  template ApexSide apex_side<D>(const std::array<Point<D>, D + 1>&, const Point<D>&, \
                                 const CheckerOptions&);                              \
  template void prove_mesh<D>(const Mesh&, const CheckerOptions&, CheckReport&);
SPILLWAY_FOR_EACH_DIMENSION(SPILLWAY_INSTANTIATE)
#undef SPILLWAY_INSTANTIATE

}  // namespace spillway::checker
