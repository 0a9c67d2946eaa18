// The base case by CGAL's incremental Delaunay triangulations: the only file of the engine that
// includes CGAL. What differs between 2D and 3D stands in CgalTraits.

#include "src/delaunay/kernel_common/insertion_arena.h"
// CGAL's way to choose the allocator of its containers.
#define CGAL_ALLOCATOR(T) spillway::delaunay::InsertionAllocator<T>

#include <CGAL/Delaunay_triangulation_2.h>
#include <CGAL/Delaunay_triangulation_3.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Triangulation_cell_base_with_info_3.h>
#include <CGAL/Triangulation_face_base_with_info_2.h>
#include <CGAL/Triangulation_vertex_base_with_info_2.h>
#include <CGAL/Triangulation_vertex_base_with_info_3.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <span>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

#include "src/delaunay/base_case/base_case.h"
#include "src/delaunay/common/hash.h"
#include "src/error.h"
#include "src/geometry/constructions/circumsphere.h"

namespace spillway::delaunay {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;

/// What a CGAL vertex knows of ours. Vertices are fresh until a point has been given to them.
struct VertexInfo {
  VertexId id = kNoVertex;
};

/// A CGAL cell's number in the list.
using CellIndex = std::uint32_t;

template <int D>
struct CgalTraits;

template <>
struct CgalTraits<2> {
  using CgalPoint = Kernel::Point_2;
  using VertexBase = CGAL::Triangulation_vertex_base_with_info_2<VertexInfo, Kernel>;
  using CellBase = CGAL::Triangulation_face_base_with_info_2<CellIndex, Kernel>;
  using Tds = CGAL::Triangulation_data_structure_2<VertexBase, CellBase>;
  using Delaunay = CGAL::Delaunay_triangulation_2<Kernel, Tds>;

  static CgalPoint point(const Point<2>& p) { return {p[0], p[1]}; }
  static auto all_cells(Delaunay& d) { return d.all_face_handles(); }
  static auto start(const Delaunay::Vertex_handle& v) { return v->face(); }
};

template <>
struct CgalTraits<3> {
  using CgalPoint = Kernel::Point_3;
  using VertexBase = CGAL::Triangulation_vertex_base_with_info_3<VertexInfo, Kernel>;
  using CellBase =
      CGAL::Triangulation_cell_base_with_info_3<CellIndex, Kernel,
                                                CGAL::Delaunay_triangulation_cell_base_3<Kernel>>;
  using Tds = CGAL::Triangulation_data_structure_3<VertexBase, CellBase>;
  using Delaunay = CGAL::Delaunay_triangulation_3<Kernel, Tds>;

  static CgalPoint point(const Point<3>& p) { return {p[0], p[1], p[2]}; }
  static auto all_cells(Delaunay& d) { return d.all_cell_handles(); }
  static auto start(const Delaunay::Vertex_handle& v) { return v->cell(); }
};

/// Builds the triangulation, giving each vertex the number of its point (its place, not yet counted
/// from first_vertex).
template <int D>
class Inserter {
  using Traits = CgalTraits<D>;

 public:
  Inserter(const BaseCaseInput<D>& input, typename Traits::Delaunay& delaunay)
      : input_(input), delaunay_(delaunay) {}

  /// The basis comes first: as long as all points are collinear or coplanar, CGAL's location takes
  /// linear time. The others follow in rounds, each a random sample of what is left and in the
  /// order of the list, so that no input is a bad one (N. Amenta, S. Choi, G. Rote, "Incremental
  /// constructions con BRIO", SoCG 2003).
  void insert_all(std::span<const VertexId> basis) {
    for (const VertexId i : basis) insert(Traits::point(input_.points[i]), i);
    const std::size_t count = input_.points.size();
    int rounds = 1;
    while ((count >> (kRoundBits * rounds)) > kSmallestRound) ++rounds;
    std::vector<std::vector<VertexId>> members(rounds);
    for (VertexId i = 0; i < count; ++i) {
      if (std::find(basis.begin(), basis.end(), i) != basis.end()) continue;
      members[std::max(0, rounds - 1 - std::countr_zero(mix64(i)) / kRoundBits)].push_back(i);
    }
    for (const std::vector<VertexId>& round : members) {
      for (const VertexId i : round) insert(Traits::point(input_.points[i]), i);
    }
  }

  /// The points that were left out, sorted.
  [[nodiscard]] std::vector<DroppedDuplicate> duplicates() const {
    // A vertex's last owner is the kept one: follow each replacement to it, the latest first.
    std::vector<DroppedDuplicate> result;
    std::unordered_map<VertexId, VertexId> owner;
    // NOLINTNEXTLINE(modernize-loop-convert): clang 14 does not take the library's reverse views.
    for (auto drop = drops_.rbegin(); drop != drops_.rend(); ++drop) {
      const auto known = owner.find(drop->kept);
      const VertexId kept = known == owner.end() ? drop->kept : known->second;
      owner.emplace(drop->dropped, kept);
      result.push_back({input_.first_vertex + drop->dropped, input_.first_vertex + kept});
    }
    std::sort(result.begin(), result.end());
    return result;
  }

 private:
  /// A round has 2^kRoundBits times the points of the one before; the first is about so large.
  static constexpr int kRoundBits = 3;
  static constexpr std::size_t kSmallestRound = 64;

  void insert(const typename Traits::CgalPoint& point, VertexId i) {
    const auto vertex =
        last_ == nullptr ? delaunay_.insert(point) : delaunay_.insert(point, Traits::start(last_));
    last_ = vertex;
    VertexId& owner = vertex->info().id;
    if (owner == kNoVertex) {
      owner = i;
    } else if (input_.input_index[i] < input_.input_index[owner]) {
      drops_.push_back({owner, i});
      owner = i;
    } else {
      drops_.push_back({i, owner});
    }
  }

  const BaseCaseInput<D>& input_;
  typename Traits::Delaunay& delaunay_;
  typename Traits::Delaunay::Vertex_handle last_;
  std::vector<DroppedDuplicate>
      drops_;  ///< in order of insertion; `kept` may itself be dropped later
};

/// BaseCase::not_inside: the infinite simplices, those near the sides of the safe box, and some
/// that are flat.
template <int D>
std::vector<std::uint32_t> list_not_inside(std::span<const Simplex<D>> simplices,
                                           const BaseCaseInput<D>& input) {
  std::vector<std::uint32_t> not_inside;
  SimplexBatch<D> batch{};
  const auto count = static_cast<std::uint32_t>(simplices.size());
  for (std::uint32_t begin = 0; begin < count; begin += batch.kSize) {
    const std::uint32_t end = std::min<std::uint32_t>(begin + batch.kSize, count);
    for (std::uint32_t s = begin; s < end; ++s) {
      // An infinite one becomes a point, of which the test of a batch knows nothing.
      const bool infinite = simplices[s].infinite();
      batch.set(s - begin, [&](int i) {
        return input.points[infinite ? 0 : simplices[s].vertices[i] - input.first_vertex];
      });
    }
    const auto inside = well_inside<D>(batch, *input.safe_box);
    for (std::uint32_t s = begin; s < end; ++s) {
      if (!inside[s - begin]) not_inside.push_back(s);
    }
  }
  return not_inside;
}

/// Makes corners of the simplices, in memory of their own, and lists the open ones if they are few.
template <int D>
void keep_corners(BaseCase<D>& base_case) {
  using Corners = std::array<VertexId, D + 1>;
  SlabArray<Simplex<D>> simplices = std::move(base_case.simplices);
  const std::size_t count = simplices.size();
  base_case.corners = {kept_or_new_slab(SlabUse::kSimplices, count * sizeof(Corners)), count};
  std::transform(simplices.begin(), simplices.end(), base_case.corners.begin(),
                 [](const Simplex<D>& simplex) { return simplex.vertices; });
  if (base_case.not_inside && base_case.not_inside->size() <= count / kFewestForOneOpen) {
    for (const std::uint32_t s : *base_case.not_inside) {
      base_case.open_simplices.push_back(simplices[s]);
    }
  }
  recycle(std::move(simplices));
}

}  // namespace

template <int D>
BaseCase<D> cgal_base_case(const BaseCaseInput<D>& input, std::span<const VertexId> basis) {
  using Traits = CgalTraits<D>;
  const InsertionArena arena;
  typename Traits::Delaunay delaunay;
  Inserter<D> inserter(input, delaunay);
  inserter.insert_all(basis);
  for (const auto vertex : delaunay.finite_vertex_handles()) {
    vertex->info().id += input.first_vertex;
  }
  delaunay.infinite_vertex()->info().id = kInfiniteVertex;

  BaseCase<D> result;
  result.dimension = D;
  result.duplicates = inserter.duplicates();
  std::size_t count = 0;
  for (const auto cell : Traits::all_cells(delaunay)) {
    cell->info() = static_cast<CellIndex>(count++);
  }
  if (count >= Simplex<D>::kLink) {
    throw Failure("a base case of " + std::to_string(input.points.size()) + " points has " +
                      std::to_string(count) +
                      " simplices, more than fit; choose smaller base cases",
                  ErrorCode::kTooLarge);
  }
  BorrowedSlab memory(SlabUse::kSimplices, count * sizeof(Simplex<D>));
  result.simplices = make_list<D>(input, *memory, count);
  Simplex<D>* next = result.simplices.data();
  for (const auto cell : Traits::all_cells(delaunay)) {
    Simplex<D>& simplex = *next++;
    for (int i = 0; i <= D; ++i) {
      simplex.vertices[i] = cell->vertex(i)->info().id;
      simplex.neighbours[i] = cell->neighbor(i)->info();
    }
    if (simplex.infinite()) result.hull.push_back(cell->info());
  }
  if (input.safe_box) result.not_inside = list_not_inside<D>(result.simplices.span(), input);
  if (input.corners_only) keep_corners(result);
  return result;
}

template BaseCase<2> cgal_base_case<2>(const BaseCaseInput<2>&, std::span<const VertexId>);
template BaseCase<3> cgal_base_case<3>(const BaseCaseInput<3>&, std::span<const VertexId>);

}  // namespace spillway::delaunay
