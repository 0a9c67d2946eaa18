#include "src/library/periodic_mesh.h"

#include <algorithm>
#include <cstdint>
#include <limits>
#include <memory>
#include <stdexcept>
#include <utility>

#include "src/geometry/dimensions.h"
#include "src/geometry/margin_survey.h"
#include "src/geometry/periodic_domain.h"
#include "src/library/interpolation.h"
#include "src/library/point_location.h"
#include "src/library/torus_cells.h"
#include "src/parallel/parallel.h"

namespace spillway::library {
namespace {

constexpr double kWidest = std::numeric_limits<double>::infinity();

/// A cell that meets the box lies within twice the radius of its circumsphere around it.
constexpr double kRadii = 2;

template <int D, class Index>
class PeriodicConstruction {
 public:
  PeriodicConstruction(const PointView<D>& points, const PeriodicBox& box,
                       const DelaunayOptions& options)
      : torus_(box, D), mesh_(copy_points<D, Index>(points, options)), options_(options) {
    with_threads(mesh_.threads, [&] {
      parallel_for(mesh_.points.size(), std::size_t{1} << 14,
                   [&](std::size_t, std::size_t begin, std::size_t end) {
                     for (std::size_t i = begin; i < end; ++i) torus_.wrap(mesh_.points[i]);
                   });
    });
    if (!options.progress) return;
    options_.progress = [this](std::size_t done, std::size_t total) { tell(done, total); };
  }

  PeriodicMesh<D, Index> make() && {
    double margin = first_margin();
    double most = PeriodicDomain::kHalf;
    for (;;) {
      const PeriodicDomain domain(torus_, margin, most);
      TorusCells<D, Index> made = triangulate(domain);
      const bool is_last_word = made.proven || domain.widest();
      if (is_last_word && torus_.closed()) refuse_long_simplices(torus_, made.reach);
      if (made.proven) return finish(std::move(made));
      if (!domain.widest()) {
        margin = wider_margin(margin, torus_);
      } else if (extra_.empty() && !made.missing.empty()) {
        // Cells between open sides may be longer than half a period, and reach as far on the other
        // side. With their corners these copies of them are Delaunay cells of the copies, too.
        extra_ = std::move(made.missing);
        extra_of_ = std::move(made.missing_of);
      } else if (most < 1) {
        most = 1;  // then all copies of all cells that meet the box are there
      } else {
        throw std::logic_error("a periodic mesh is not closed: a fault of the program");
      }
    }
  }

 private:
  [[nodiscard]] double first_margin() const {
    if (!torus_.closed()) return kWidest;
    MarginSurvey survey(torus_);
    survey.add(span_of(mesh_.points));
    return kRadii * survey.margin();
  }

  TorusCells<D, Index> triangulate(const PeriodicDomain& domain) {
    copies_ = {};
    copies_.threads = mesh_.threads;
    copy(domain);
    make_cells(copies_, mesh_.points.size(), options_);
    TorusCells<D, Index> made;
    with_threads(mesh_.threads, [&] {
      made = choose_torus_cells<D, Index>(domain, {copies_.view(), mesh_.points.size(), point_of_});
    });
    return made;
  }

  /// The points in the box, and behind them their copies.
  void copy(const PeriodicDomain& domain) {
    const std::size_t count = mesh_.points.size();
    std::vector<Point<D>> outside;
    point_of_.resize(count);
    for (std::size_t i = 0; i < count; ++i) {
      point_of_[i] = static_cast<Index>(i);
      const Point<D>& point = mesh_.points[i];
      if (!domain.has_copies(point)) continue;
      std::array<PeriodicDomain::CopiesAlong, D> along;
      int copies = 1;
      for (int k = 0; k < D; ++k) {
        along[k] = domain.copies_along(k, point[k]);
        copies *= along[k].count;
      }
      for (int n = 1; n < copies; ++n) {
        Point<D>& copy = outside.emplace_back();
        for (int k = 0, rest = n; k < D; rest /= along[k++].count) {
          copy[k] = along[k].coordinates[rest % along[k].count];
        }
      }
      require_point_numbers<Index>(count + outside.size(), "points with their copies");
      point_of_.resize(count + outside.size(), static_cast<Index>(i));
    }
    outside.insert(outside.end(), extra_.begin(), extra_.end());
    point_of_.insert(point_of_.end(), extra_of_.begin(), extra_of_.end());
    require_point_numbers<Index>(count + outside.size(), "points with their copies");
    copies_.points = SlabArray<Point<D>>(count + outside.size());
    std::copy(mesh_.points.begin(), mesh_.points.end(), copies_.points.begin());
    std::copy(outside.begin(), outside.end(), copies_.points.begin() + count);
  }

  PeriodicMesh<D, Index> finish(TorusCells<D, Index> made) {
    const auto count = static_cast<Index>(mesh_.points.size());
    std::copy_if(copies_.duplicates.begin(), copies_.duplicates.end(),
                 std::back_inserter(mesh_.duplicates),
                 [count](const auto& duplicate) { return duplicate.point < count; });
    copies_.duplicates = {};
    mesh_.cells = std::move(made.cells);
    mesh_.offsets = std::move(made.offsets);
    auto copies = std::make_unique<const PeriodicCopies<D, Index>>(
        torus_, std::move(copies_), std::move(point_of_), std::move(made.kept),
        std::move(made.number));
    return {std::move(mesh_), std::move(copies)};
  }

  /// Tells of the points without copies, and never of less than before.
  void tell(std::size_t done, std::size_t total) {
    const std::size_t points = mesh_.points.size();
    const auto share = static_cast<double>(done) / static_cast<double>(total);
    const std::size_t now =
        done == total ? points : static_cast<std::size_t>(share * static_cast<double>(points));
    if (now <= told_) return;
    told_ = now;
    progress_(now, points);
  }

  const Torus torus_;
  MeshData<D, Index> mesh_;
  DelaunayOptions options_;
  const std::function<void(std::size_t, std::size_t)> progress_ = options_.progress;
  std::size_t told_ = 0;
  MeshData<D, Index> copies_;
  std::vector<Index> point_of_;
  std::vector<Point<D>> extra_;  ///< copies beyond the margin
  std::vector<Index> extra_of_;
};

}  // namespace

template <int D, class Index>
void PeriodicCopies<D, Index>::locate(std::span<const Point<D>> places,
                                      std::span<Index> cells) const {
  const auto view = mesh_.view();
  const auto found = locate_all<D>(view, starts(), places);
  for (std::size_t j = 0; j < places.size(); ++j) {
    cells[j] = -1;
    if (found[j].cell < 0) continue;
    for (const Index cell : cells_around<D>(view, places[j], found[j].cell)) {
      const Index number = number_[cell];
      if (number >= 0 && (cells[j] < 0 || number < cells[j])) cells[j] = number;
    }
  }
}

template <int D, class Index>
void PeriodicCopies<D, Index>::find_nearest(std::span<const Point<D>> places,
                                            std::span<Index> points) const {
  const auto view = mesh_.view();
  Index cell = starts().find(places[0]);
  for (std::size_t j = 0; j < places.size(); ++j) {
    const Index nearest = nearest_vertex<D>(view, places[j], cell);
    cell = view.vertex_cells[nearest];
    points[j] = point_of_[nearest];
    for (const Index vertex : vertices_as_near<D>(view, places[j], nearest)) {
      points[j] = std::min(points[j], point_of_[vertex]);
    }
  }
}

template <int D, class Index>
void PeriodicCopies<D, Index>::interpolate(std::span<const double> values,
                                           std::span<const Point<D>> places,
                                           std::span<double> found) const {
  const auto view = mesh_.view();
  const auto locations = locate_all<D>(view, starts(), places);
  for (std::size_t j = 0; j < places.size(); ++j) {
    const Index cell = locations[j].cell;
    found[j] = cell < 0 ? std::numeric_limits<double>::quiet_NaN()
                        : interpolated_value<D>(view, values, cell, places[j]);
  }
}

template <int D, class Index>
std::vector<double> PeriodicCopies<D, Index>::values_of_copies(
    std::span<const double> values) const {
  std::vector<double> all(point_of_.size());
  for (std::size_t i = 0; i < all.size(); ++i) all[i] = values[point_of_[i]];
  return all;
}

template <int D, class Index>
PeriodicMesh<D, Index> make_periodic_mesh(const PointView<D>& points, const PeriodicBox& box,
                                          const DelaunayOptions& options) {
  return PeriodicConstruction<D, Index>(points, box, options).make();
}

#define SPILLWAY_INSTANTIATE_INDEX(D, Index)                                                     \
  template class PeriodicCopies<D, Index>;                                                       \
  template PeriodicMesh<D, Index> make_periodic_mesh<D>(const PointView<D>&, const PeriodicBox&, \
                                                        const DelaunayOptions&);
#define SPILLWAY_INSTANTIATE(D)               \
  SPILLWAY_INSTANTIATE_INDEX(D, std::int32_t) \
  SPILLWAY_INSTANTIATE_INDEX(D, std::int64_t)
SPILLWAY_FOR_EACH_CUT_DIMENSION(SPILLWAY_INSTANTIATE)
#undef SPILLWAY_INSTANTIATE
#undef SPILLWAY_INSTANTIATE_INDEX

}  // namespace spillway::library
