#include <spillway/delaunay.h>

#include <fmt/format.h>

#include <cmath>
#include <functional>
#include <limits>
#include <mutex>
#include <span>
#include <utility>
#include <vector>

#include "src/geometry/canonical_hash.h"
#include "src/geometry/constructions/circumcentre.h"
#include "src/geometry/dimensions.h"
#include "src/library/construction.h"
#include "src/library/float_environment.h"
#include "src/library/interpolation.h"
#include "src/library/periodic_mesh.h"
#include "src/library/point_location.h"
#include "src/library/query_order.h"
#include "src/library/search_starts.h"
#include "src/library/start_tree.h"
#include "src/parallel/parallel.h"

namespace spillway {
namespace {

constexpr std::size_t kCellGrain = std::size_t{1} << 14;

/// For each place what answer(places, answers) puts into `answers`, `none` for places that are not
/// finite. It is asked for some places at a time, each near the one before it. With a torus, places
/// are brought into its box.
template <int D, typename Answer>
std::vector<Answer> answer_all(
    unsigned threads, const PointView<D>& places, Answer none,
    const std::function<void(std::span<const Point<D>>, std::span<Answer>)>& answer,
    const geometry::Torus* torus = nullptr) {
  std::vector<Answer> answers(places.size(), none);
  library::for_each_near<D>(
      places.size(), threads,
      [&](std::size_t i) {
        Point<D> place = places[i];
        if (torus != nullptr && library::is_finite<D>(place)) torus->wrap(place);
        return place;
      },
      [&](std::span<const Point<D>> near, std::span<const std::size_t> numbers) {
        std::vector<Answer> some(near.size());
        answer(near, some);
        for (std::size_t j = 0; j < some.size(); ++j) answers[numbers[j]] = some[j];
      });
  return answers;
}

/// The same for a single finite place in a periodic mesh.
template <int D, class Index>
Index answer_in_box(const library::PeriodicCopies<D, Index>& copies, const Point<D>& place,
                    void (library::PeriodicCopies<D, Index>::*question)(std::span<const Point<D>>,
                                                                        std::span<Index>) const) {
  const Point<D> inside = copies.in_box(place);
  Index answer = -1;
  (copies.*question)(std::span(&inside, 1), std::span(&answer, 1));
  return answer;
}

}  // namespace

template <int D, class Index>
struct Delaunay<D, Index>::Mesh : library::MeshData<D, Index> {
  /// What periodic meshes have besides; of other dimensions there are none.
  static constexpr bool kMayRepeat = D <= 3;
  using Copies = library::PeriodicCopies<kMayRepeat ? D : 2, Index>;

  explicit Mesh(library::MeshData<D, Index> data, std::unique_ptr<const Copies> made = nullptr)
      : library::MeshData<D, Index>(std::move(data)), copies(std::move(made)) {}

  std::unique_ptr<const Copies> copies;  ///< null if the mesh is not periodic

  /// Of a periodic mesh those of the copy of a cell whose centre lies in the box.
  [[nodiscard]] std::array<Point<D>, D + 1> corners_as_placed(Index cell) const {
    if constexpr (kMayRepeat) {
      if (copies) return copies->corners(cell);
    }
    return this->view().corners(cell);
  }

  [[nodiscard]] const library::StartTree<D, Index>& starts() const {
    return starts_.of(this->view(), this->threads);
  }

 private:
  library::SearchStarts<D, Index> starts_;
};

template <int D, class Index>
Delaunay<D, Index>::Delaunay(PointView<D> points, const DelaunayOptions& options) {
  const library::FloatEnvironment environment;
  if (!options.periodic) {
    mesh_ = std::make_unique<const Mesh>(library::make_mesh<D, Index>(points, options));
    return;
  }
  if constexpr (Mesh::kMayRepeat) {
    auto made = library::make_periodic_mesh<D, Index>(points, *options.periodic, options);
    mesh_ = std::make_unique<const Mesh>(std::move(made.mesh), std::move(made.copies));
  } else {
    throw Error(ErrorCode::kInvalidArgument,
                fmt::format("periodic boxes have 2 or 3 dimensions, not {}", D));
  }
}

template <int D, class Index>
Delaunay<D, Index>::Delaunay(Delaunay&&) noexcept = default;
template <int D, class Index>
Delaunay<D, Index>& Delaunay<D, Index>::operator=(Delaunay&&) noexcept = default;
template <int D, class Index>
Delaunay<D, Index>::~Delaunay() = default;

template <int D, class Index>
std::size_t Delaunay<D, Index>::point_count() const {
  return mesh_->points.size();
}

template <int D, class Index>
std::size_t Delaunay<D, Index>::vertex_count() const {
  return mesh_->points.size() - mesh_->duplicates.size();
}

template <int D, class Index>
std::size_t Delaunay<D, Index>::cell_count() const {
  return mesh_->cells.vertices.size() / (D + 1);
}

template <int D, class Index>
std::span<const Point<D>> Delaunay<D, Index>::points() const {
  return library::span_of(mesh_->points);
}

template <int D, class Index>
std::span<const Index> Delaunay<D, Index>::cell_vertices() const {
  return library::span_of(mesh_->cells.vertices);
}

template <int D, class Index>
std::span<const Index> Delaunay<D, Index>::cell_neighbours() const {
  return library::span_of(mesh_->cells.neighbours);
}

template <int D, class Index>
std::span<const Index> Delaunay<D, Index>::hull_facets() const {
  return library::span_of(mesh_->cells.hull_facets);
}

template <int D, class Index>
std::span<const Index> Delaunay<D, Index>::hull_cells() const {
  return library::span_of(mesh_->cells.hull_cells);
}

template <int D, class Index>
std::span<const Duplicate<Index>> Delaunay<D, Index>::duplicates() const {
  return mesh_->duplicates;
}

template <int D, class Index>
std::span<const Index> Delaunay<D, Index>::vertex_cells() const {
  return library::span_of(mesh_->cells.vertex_cells);
}

template <int D, class Index>
std::span<const std::int8_t> Delaunay<D, Index>::cell_offsets() const {
  return library::span_of(mesh_->offsets);
}

template <int D, class Index>
std::optional<PeriodicBox> Delaunay<D, Index>::periodic() const {
  if (!mesh_->copies) return std::nullopt;
  return mesh_->copies->torus().box();
}

template <int D, class Index>
Point<D> Delaunay<D, Index>::circumcentre(Index cell) const {
  if (cell < 0 || static_cast<std::size_t>(cell) >= cell_count()) {
    throw Error(ErrorCode::kInvalidArgument,
                fmt::format("there is no cell {}: the mesh has {}", cell, cell_count()));
  }
  const library::FloatEnvironment environment;
  return geometry::circumcentre<D>(mesh_->corners_as_placed(cell));
}

template <int D, class Index>
std::vector<Point<D>> Delaunay<D, Index>::circumcentres() const {
  const library::FloatEnvironment environment;
  std::vector<Point<D>> centres(cell_count());
  parallel::with_threads(mesh_->threads, [&] {
    parallel::parallel_for(centres.size(), kCellGrain,
                           [&](std::size_t, std::size_t begin, std::size_t end) {
                             for (std::size_t c = begin; c < end; ++c) {
                               const auto corners = mesh_->corners_as_placed(static_cast<Index>(c));
                               centres[c] = geometry::circumcentre<D>(corners);
                             }
                           });
  });
  return centres;
}

template <int D, class Index>
std::uint64_t Delaunay<D, Index>::canonical_hash() const {
  const auto view = mesh_->view();
  const std::size_t cells = cell_count();
  geometry::CanonicalHash<D> hash;
  std::mutex mutex;  // guards hash, a sum whose order does not matter
  parallel::with_threads(mesh_->threads, [&] {
    parallel::parallel_for(cells, kCellGrain, [&](std::size_t, std::size_t begin, std::size_t end) {
      geometry::CanonicalHash<D> some;
      for (std::size_t c = begin; c < end; ++c) some.add(view.corners(static_cast<Index>(c)));
      const std::lock_guard lock(mutex);
      hash.add(some);
    });
  });
  return hash.value();
}

template <int D, class Index>
Index Delaunay<D, Index>::locate(const Point<D>& place) const {
  if (!library::is_finite<D>(place)) return -1;
  const library::FloatEnvironment environment;
  if constexpr (Mesh::kMayRepeat) {
    if (mesh_->copies) return answer_in_box<D, Index>(*mesh_->copies, place, &Mesh::Copies::locate);
  }
  return library::locate<D>(mesh_->view(), place, mesh_->starts().find(place)).cell;
}

template <int D, class Index>
std::vector<Index> Delaunay<D, Index>::locate(PointView<D> places) const {
  const library::FloatEnvironment environment;
  if constexpr (Mesh::kMayRepeat) {
    if (const auto* const copies = mesh_->copies.get()) {
      copies->prepare();
      return answer_all<D, Index>(
          mesh_->threads, places, -1,
          [&](std::span<const Point<D>> near, std::span<Index> cells) {
            copies->locate(near, cells);
          },
          &copies->torus());
    }
  }
  const auto view = mesh_->view();
  const auto& starts = mesh_->starts();
  return answer_all<D, Index>(mesh_->threads, places, -1,
                              [&](std::span<const Point<D>> near, std::span<Index> cells) {
                                const auto locations = library::locate_all<D>(view, starts, near);
                                for (std::size_t j = 0; j < near.size(); ++j)
                                  cells[j] = locations[j].cell;
                              });
}

template <int D, class Index>
Index Delaunay<D, Index>::nearest_vertex(const Point<D>& place) const {
  if (!library::is_finite<D>(place)) return -1;
  const library::FloatEnvironment environment;
  if constexpr (Mesh::kMayRepeat) {
    if (mesh_->copies) {
      return answer_in_box<D, Index>(*mesh_->copies, place, &Mesh::Copies::find_nearest);
    }
  }
  return library::nearest_vertex<D>(mesh_->view(), place, mesh_->starts().find(place));
}

template <int D, class Index>
std::vector<Index> Delaunay<D, Index>::nearest_vertex(PointView<D> places) const {
  const library::FloatEnvironment environment;
  if constexpr (Mesh::kMayRepeat) {
    if (const auto* const copies = mesh_->copies.get()) {
      copies->prepare();
      return answer_all<D, Index>(
          mesh_->threads, places, -1,
          [&](std::span<const Point<D>> near, std::span<Index> vertices) {
            copies->find_nearest(near, vertices);
          },
          &copies->torus());
    }
  }
  const auto view = mesh_->view();
  const auto& starts = mesh_->starts();
  return answer_all<D, Index>(mesh_->threads, places, -1,
                              [&](std::span<const Point<D>> near, std::span<Index> vertices) {
                                Index cell = starts.find(near[0]);
                                for (std::size_t j = 0; j < near.size(); ++j) {
                                  vertices[j] = library::nearest_vertex<D>(view, near[j], cell);
                                  cell = view.vertex_cells[vertices[j]];
                                }
                              });
}

template <int D, class Index>
std::vector<double> Delaunay<D, Index>::interpolate(std::span<const double> values,
                                                    PointView<D> places) const {
  if (values.size() != point_count()) {
    throw Error(ErrorCode::kInvalidArgument,
                fmt::format("{} values for {} points: there must be one for each", values.size(),
                            point_count()));
  }
  const library::FloatEnvironment environment;
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  if constexpr (Mesh::kMayRepeat) {
    if (const auto* const copies = mesh_->copies.get()) {
      copies->prepare();
      const std::vector<double> all = copies->values_of_copies(values);
      return answer_all<D, double>(
          mesh_->threads, places, kNone,
          [&](std::span<const Point<D>> near, std::span<double> found) {
            copies->interpolate(all, near, found);
          },
          &copies->torus());
    }
  }
  const auto view = mesh_->view();
  const auto& starts = mesh_->starts();
  return answer_all<D, double>(
      mesh_->threads, places, kNone, [&](std::span<const Point<D>> near, std::span<double> found) {
        const auto locations = library::locate_all<D>(view, starts, near);
        for (std::size_t j = 0; j < near.size(); ++j) {
          const Index cell = locations[j].cell;
          found[j] = cell < 0 ? kNone : library::interpolated_value<D>(view, values, cell, near[j]);
        }
      });
}

#define SPILLWAY_INSTANTIATE(D)             \
  template class Delaunay<D, std::int32_t>; \
  template class Delaunay<D, std::int64_t>;
SPILLWAY_FOR_EACH_DIMENSION(SPILLWAY_INSTANTIATE)
#undef SPILLWAY_INSTANTIATE

}  // namespace spillway
