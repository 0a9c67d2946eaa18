#include "tools/checker.h"

#include <algorithm>
#include <cmath>

#include "src/error.h"
#include "src/geometry/canonical_hash.h"
#include "tools/mesh_proof.h"

namespace spillway {
namespace {

void require_dimension(const Mesh& mesh) {
  if (mesh.header.dimension != 2 && mesh.header.dimension != 3) {
    throw Error(fmt::format("a mesh of dimension {} cannot be checked: only 2 and 3 can",
                            mesh.header.dimension));
  }
}

template <int D>
Point<D> output_point(const Point<3>& p) {
  Point<D> result;
  std::copy_n(p.begin(), D, result.begin());
  return result;
}

template <int D>
std::uint64_t hash_of(const Mesh& mesh) {
  CanonicalHash<D> hash;
  for (std::size_t s = 0; s + D < mesh.corners.size(); s += D + 1) {
    std::array<Point<D>, D + 1> simplex;
    for (int i = 0; i <= D; ++i) {
      const std::uint64_t vertex = mesh.corners[s + i];
      if (vertex >= mesh.vertices.size()) {
        throw Error(fmt::format("{} {} names vertex {}, but the mesh has {} vertices",
                                Words<D>::kSimplex, s / (D + 1), vertex, mesh.vertices.size()));
      }
      simplex[i] = output_point<D>(mesh.vertices[vertex]);
    }
    hash.add(simplex);
  }
  return hash.value();
}

// Points in lexicographic order with their numbers.
template <int D>
using Numbered = std::vector<std::pair<Point<D>, std::uint64_t>>;

// Adds a fault for every point that is not finite: such points have no order.
template <int D>
Numbered<D> sorted(const std::vector<Point<3>>& points, const char* name, Faults& faults) {
  Numbered<D> result;
  result.reserve(points.size());
  for (std::uint64_t i = 0; i < points.size(); ++i) {
    const Point<D> p = output_point<D>(points[i]);
    if (std::all_of(p.begin(), p.end(), [](double c) { return std::isfinite(c); })) {
      result.emplace_back(p, i);
    } else {
      faults.add("{} {} has a coordinate that is not finite", name, i);
    }
  }
  std::sort(result.begin(), result.end());
  return result;
}

template <int D>
void compare_vertex_set(const Mesh& mesh, const std::vector<Point<3>>& input, CheckReport& report,
                        Faults& faults) {
  const std::uint64_t before = faults.count();
  const Numbered<D> vertices = sorted<D>(mesh.vertices, "vertex", faults);
  Numbered<D> points = sorted<D>(input, "input point", faults);
  const auto same_point = [](const auto& a, const auto& b) { return a.first == b.first; };
  points.erase(std::unique(points.begin(), points.end(), same_point), points.end());

  auto v = vertices.begin();
  auto p = points.begin();
  while (v != vertices.end() || p != points.end()) {
    if (p == points.end() || (v != vertices.end() && v->first < p->first)) {
      faults.add("vertex {} ({}) is no point of the input", v->second, fmt::join(v->first, ", "));
      ++v;
    } else if (v == vertices.end() || p->first < v->first) {
      faults.add("input point {} ({}) is no vertex of the mesh", p->second,
                 fmt::join(p->first, ", "));
      ++p;
    } else {
      const auto next = v + 1;
      if (next == vertices.end() || !same_point(*next, *v)) ++p;
      v = next;
    }
  }
  if (faults.count() == before) {
    report.proved.push_back(
        fmt::format("the vertices are the {} distinct points of the input", points.size()));
  }
}

}  // namespace

CheckReport check_mesh(const Mesh& mesh, const CheckOptions& options) {
  require_dimension(mesh);
  CheckReport report;
  report.vertices = mesh.vertices.size();
  report.simplices = mesh.corners.size() / mesh.corners_per_simplex();
  if (mesh.header.dimension == 2) {
    prove_mesh<2>(mesh, options, report);
  } else {
    prove_mesh<3>(mesh, options, report);
  }
  return report;
}

void check_vertex_set(const Mesh& mesh, const std::vector<Point<3>>& input, CheckReport& report,
                      const CheckOptions& options) {
  require_dimension(mesh);
  Faults faults(report, options.most_faults);
  if (mesh.header.dimension == 2) {
    compare_vertex_set<2>(mesh, input, report, faults);
  } else {
    compare_vertex_set<3>(mesh, input, report, faults);
  }
}

std::uint64_t canonical_hash(const Mesh& mesh) {
  require_dimension(mesh);
  return mesh.header.dimension == 2 ? hash_of<2>(mesh) : hash_of<3>(mesh);
}

}  // namespace spillway
