#include "tests/delaunay/verify.h"

#include <algorithm>
#include <set>

#include "src/geometry/dimensions.h"
#include "src/geometry/predicates.h"

namespace spillway::test {
namespace {

constexpr std::size_t kMostFaults = 10;

std::string describe(SimplexId id) {
  return "simplex " + std::to_string(id.list) + ":" + std::to_string(id.index);
}

template <int D>
class Verifier {
 public:
  explicit Verifier(const Triangulation<D>& triangulation) : t_(triangulation) {}

  std::vector<std::string> run() && {
    t_.for_each_simplex(
        [&](SimplexId id, const Simplex<D>& simplex) { check_vertices(id, simplex); });
    if (!faults_.empty()) return std::move(faults_);
    t_.for_each_simplex([&](SimplexId id, const Simplex<D>& simplex) {
      check_orientation(id, simplex);
      for (int i = 0; i <= D; ++i) {
        if (check_neighbour(id, simplex, i)) check_facet(id, simplex, i);
      }
    });
    check_counts();
    return std::move(faults_);
  }

 private:
  void fault(const std::string& text) {
    if (faults_.size() < kMostFaults) faults_.push_back(text);
  }

  void check_vertices(SimplexId id, const Simplex<D>& simplex) {
    std::set<VertexId> distinct(simplex.vertices.begin(), simplex.vertices.end());
    if (distinct.size() != D + 1) fault(describe(id) + " has a vertex twice");
    for (const VertexId v : distinct) {
      if (v != kInfiniteVertex && v >= t_.points.size()) {
        fault(describe(id) + " has vertex " + std::to_string(v) + ", which doesn't exist");
      }
    }
  }

  void check_orientation(SimplexId id, const Simplex<D>& simplex) {
    if (!simplex.infinite() && orientation<D>(corners(simplex)) <= 0) {
      fault(describe(id) + " is not positively oriented");
    }
  }

  bool check_neighbour(SimplexId id, const Simplex<D>& simplex, int i) {
    const SimplexId other = t_.neighbour(id, i);
    if (other.list >= t_.lists.size() || other.index >= t_.lists[other.list].simplices.size() ||
        t_.simplex(other).removed()) {
      fault(describe(id) + " has a neighbour that doesn't exist");
      return false;
    }
    const Simplex<D>& neighbour = t_.simplex(other);
    for (int j = 0; j <= D; ++j) {
      if (t_.neighbour(other, j) == id && facet(simplex, i) == facet(neighbour, j)) {
        return true;
      }
    }
    fault(describe(id) + " and its neighbour " + describe(other) + " don't share a facet");
    return false;
  }

  /// Locally Delaunay, and at the hull convex: the neighbour's far vertex lies outside.
  void check_facet(SimplexId id, const Simplex<D>& simplex, int i) {
    const SimplexId other = t_.neighbour(id, i);
    const VertexId apex = far_vertex(t_.simplex(other), simplex);
    if (apex == kInfiniteVertex) return;
    const int infinite_corner = simplex.infinite_corner();
    if (infinite_corner < 0) {
      if (in_sphere<D>(corners(simplex), t_.points[apex]) >= 0) {
        fault(describe(id) + " has vertex " + std::to_string(apex) + " in its circumsphere");
      }
    } else if (infinite_corner != i) {
      std::array<Point<D>, D + 1> with_apex;
      for (int k = 0; k <= D; ++k) {
        with_apex[k] = t_.points[k == infinite_corner ? apex : simplex.vertices[k]];
      }
      if (orientation<D>(with_apex) > 0) {
        fault(describe(id) + " on the hull has vertex " + std::to_string(apex) + " beyond it");
      }
    }
  }

  /// All distinct points used; hull listed; V - E + F - C = 1 + (-1)^D for finite and infinite
  /// simplices together, which form a D-sphere: in 2D as simplices = 2 vertices - 4.
  void check_counts() {
    std::set<VertexId> used;
    std::set<std::pair<VertexId, VertexId>> edges;
    std::size_t simplices = 0;
    std::set<SimplexId> infinite;
    t_.for_each_simplex([&](SimplexId id, const Simplex<D>& simplex) {
      ++simplices;
      if (simplex.infinite()) infinite.insert(id);
      for (int i = 0; i <= D; ++i) {
        used.insert(simplex.vertices[i]);
        for (int j = 0; j < i; ++j) {
          edges.insert(std::minmax(simplex.vertices[i], simplex.vertices[j]));
        }
      }
    });
    if (infinite != std::set<SimplexId>(t_.hull.begin(), t_.hull.end()) ||
        infinite.size() != t_.hull.size()) {
      fault("the list of hull simplices is not that of the infinite ones");
    }
    if (t_.dimension < D) {
      if (simplices != 0) fault("there are simplices although the points span fewer dimensions");
      return;
    }
    if (used.size() != t_.vertex_count() + 1) {
      fault("simplices use " + std::to_string(used.size()) +
            " vertices (the infinite one included), not " + std::to_string(t_.vertex_count() + 1));
    }
    if constexpr (D <= 3) {
      const std::size_t facets = simplices * (D + 1) / 2;
      const auto euler =
          static_cast<std::int64_t>(used.size()) - static_cast<std::int64_t>(edges.size()) +
          (D == 2 ? static_cast<std::int64_t>(simplices)
                  : static_cast<std::int64_t>(facets) - static_cast<std::int64_t>(simplices));
      if (euler != (D == 2 ? 2 : 0)) fault("Euler's relation fails: " + std::to_string(euler));
    }
    for (const DroppedDuplicate& d : t_.duplicates) {
      if (used.count(d.dropped) != 0 || used.count(d.kept) == 0 ||
          t_.points[d.dropped] != t_.points[d.kept] ||
          t_.input_index[d.dropped] < t_.input_index[d.kept]) {
        fault("point " + std::to_string(d.dropped) + " is not properly listed as a duplicate");
      }
    }
  }

  [[nodiscard]] std::array<Point<D>, D + 1> corners(const Simplex<D>& simplex) const {
    std::array<Point<D>, D + 1> corners;
    for (int i = 0; i <= D; ++i) corners[i] = t_.points[simplex.vertices[i]];
    return corners;
  }

  static std::set<VertexId> facet(const Simplex<D>& simplex, int i) {
    std::set<VertexId> facet(simplex.vertices.begin(), simplex.vertices.end());
    facet.erase(simplex.vertices[i]);
    return facet;
  }

  /// The vertex of `other` that `simplex` does not have.
  static VertexId far_vertex(const Simplex<D>& other, const Simplex<D>& simplex) {
    return *std::find_if(other.vertices.begin(), other.vertices.end(), [&](VertexId v) {
      return std::find(simplex.vertices.begin(), simplex.vertices.end(), v) ==
             simplex.vertices.end();
    });
  }

  const Triangulation<D>& t_;
  std::vector<std::string> faults_;
};

}  // namespace

template <int D>
std::vector<std::string> verify(const Triangulation<D>& triangulation) {
  return Verifier<D>(triangulation).run();
}

#define SPILLWAY_INSTANTIATE(D) \
  template std::vector<std::string> verify<D>(const Triangulation<D>&);
SPILLWAY_FOR_EACH_DIMENSION(SPILLWAY_INSTANTIATE)
#undef SPILLWAY_INSTANTIATE

}  // namespace spillway::test
