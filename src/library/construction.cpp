#include "src/library/construction.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <limits>
#include <mutex>
#include <utility>

#include "src/delaunay/delaunay.h"
#include "src/error.h"
#include "src/geometry/dimensions.h"
#include "src/library/cell_numbers.h"
#include "src/library/query_order.h"
#include "src/parallel/most_threads.h"
#include "src/parallel/parallel.h"

namespace spillway::library {
namespace {

using PublicError = Error;

constexpr std::size_t kGrain = std::size_t{1} << 14;

template <class Index>
constexpr std::size_t kMostNumbers = static_cast<std::size_t>(std::numeric_limits<Index>::max());
template <class Index>
constexpr std::size_t kMostPoints = std::min(kMostNumbers<Index>, kMaxVertices);

/// A copy of the points; throws unless all are finite. Made by all threads.
template <int D>
SlabArray<Point<D>> copy_finite(const PointView<D>& points) {
  SlabArray<Point<D>> copy(points.size());
  std::atomic<std::size_t> bad = points.size();  // the first that is not finite
  parallel_for(points.size(), kGrain, [&](std::size_t, std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      copy[i] = points[i];
      if (is_finite<D>(copy[i])) continue;
      std::size_t lowest = bad;
      while (i < lowest && !bad.compare_exchange_weak(lowest, i)) {
      }
      return;
    }
  });
  if (bad < points.size()) {
    throw PublicError(ErrorCode::kInvalidArgument,
                      fmt::format("point {} has a coordinate that is not finite: ({})", bad.load(),
                                  fmt::join(points[bad], ", ")));
  }
  return copy;
}

/// Tells a program of progress, one call at a time, in ascending order.
class ProgressTeller {
 public:
  ProgressTeller(const std::function<void(std::size_t, std::size_t)>& progress, std::size_t total)
      : progress_(progress), total_(total) {}

  void tell(std::size_t done) {
    const std::lock_guard lock(mutex_);
    if (done <= told_) return;
    told_ = done;
    progress_(done, total_);
  }

 private:
  const std::function<void(std::size_t, std::size_t)>& progress_;
  std::size_t total_;
  std::mutex mutex_;
  std::size_t told_ = 0;  // guarded by mutex_
};

template <int D>
Triangulation<D> triangulate(std::span<const Point<D>> points, const DelaunayOptions& options,
                             unsigned threads) {
  ProgressTeller teller(options.progress, points.size());
  delaunay::DivideAndConquerOptions engine;
  engine.threads = threads;
  engine.stop = options.stop;
  if (options.progress) engine.progress = [&](std::size_t done) { teller.tell(done); };
  return delaunay_triangulation<D>(points, engine);
}

/// Throws unless the points span D dimensions.
void require_span(int dimension, int needed, std::size_t points) {
  if (dimension == needed) return;
  const std::string cell = needed == 2   ? "triangle"
                           : needed == 3 ? "tetrahedron"
                                         : fmt::format("simplex of {} dimensions", needed);
  if (dimension < 0) {
    throw PublicError(ErrorCode::kDegenerateInput,
                      fmt::format("there are no points, so there is no {}", cell));
  }
  const std::string where = dimension == 0   ? "at one place"
                            : dimension == 1 ? "on one line"
                            : dimension == 2 ? "on one plane"
                                             : fmt::format("in {} dimensions", dimension);
  throw PublicError(ErrorCode::kDegenerateInput,
                    fmt::format("all points ({}) lie {}: they span no {}", points, where, cell));
}

template <int D, class Index>
std::vector<Duplicate<Index>> list_duplicates(const Triangulation<D>& triangulation) {
  std::vector<Duplicate<Index>> duplicates;
  duplicates.reserve(triangulation.duplicates.size());
  for (const auto& [dropped, kept] : triangulation.duplicates) {
    duplicates.push_back({static_cast<Index>(triangulation.input_index[dropped]),
                          static_cast<Index>(triangulation.input_index[kept])});
  }
  std::sort(duplicates.begin(), duplicates.end(),
            [](const auto& a, const auto& b) { return a.point < b.point; });
  return duplicates;
}

}  // namespace

template <class Index>
void require_point_numbers(std::size_t count, const std::string& things) {
  require_numbers(count, kMostPoints<Index>, things);
}

void require_numbers(std::size_t count, std::size_t most, const std::string& things) {
  if (count <= most) return;
  throw PublicError(ErrorCode::kTooLarge,
                    fmt::format("{} {}: at most {} can be numbered", count, things, most));
}

template <int D, class Index>
MeshData<D, Index> copy_points(const PointView<D>& points, const DelaunayOptions& options) {
  if (options.threads > kMostThreads) {
    throw PublicError(
        ErrorCode::kInvalidArgument,
        fmt::format("{} threads: there may be at most {}", options.threads, kMostThreads));
  }
  require_point_numbers<Index>(points.size(), "points");
  MeshData<D, Index> mesh;
  mesh.threads = options.threads == 0 ? available_threads() : options.threads;
  if (options.stop.stop_requested()) throw Interrupted();
  with_threads(mesh.threads, [&] { mesh.points = copy_finite<D>(points); });
  return mesh;
}

template <int D, class Index>
void make_cells(MeshData<D, Index>& mesh, std::size_t points, const DelaunayOptions& options) {
  const Triangulation<D> triangulation =
      triangulate<D>(span_of(mesh.points), options, mesh.threads);
  require_span(triangulation.dimension, D, points);
  with_threads(mesh.threads, [&] {
    const CellNumbers<D> numbers(triangulation);
    require_numbers(numbers.count(), kMostNumbers<Index>, "cells");
    if (options.stop.stop_requested()) throw Interrupted();
    mesh.cells = make_cell_arrays<D, Index>(triangulation, numbers);
    mesh.duplicates = list_duplicates<D, Index>(triangulation);
  });
}

template <int D, class Index>
MeshData<D, Index> make_mesh(const PointView<D>& points, const DelaunayOptions& options) {
  MeshData<D, Index> mesh = copy_points<D, Index>(points, options);
  make_cells(mesh, points.size(), options);
  return mesh;
}

template void require_point_numbers<std::int32_t>(std::size_t, const std::string&);
template void require_point_numbers<std::int64_t>(std::size_t, const std::string&);

#define SPILLWAY_INSTANTIATE_INDEX(D, Index)                                               \
  template MeshData<D, Index> copy_points<D>(const PointView<D>&, const DelaunayOptions&); \
  template void make_cells<D>(MeshData<D, Index>&, std::size_t, const DelaunayOptions&);   \
  template MeshData<D, Index> make_mesh<D>(const PointView<D>&, const DelaunayOptions&);
#define SPILLWAY_INSTANTIATE(D)               \
  SPILLWAY_INSTANTIATE_INDEX(D, std::int32_t) \
  SPILLWAY_INSTANTIATE_INDEX(D, std::int64_t)
SPILLWAY_FOR_EACH_DIMENSION(SPILLWAY_INSTANTIATE)
#undef SPILLWAY_INSTANTIATE
#undef SPILLWAY_INSTANTIATE_INDEX

}  // namespace spillway::library
