#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <stop_token>
#include <vector>

#include "src/delaunay/base_case/base_case.h"
#include "src/delaunay/common/triangulation.h"
#include "src/delaunay/division/divide.h"

namespace spillway::runtime {
struct Task;
}

namespace spillway::delaunay {

/// How `delaunay` does its work. None of it changes the set of simplices.
struct DivideAndConquerOptions {
  unsigned threads = 0;         ///< 0: as many as the machine has
  std::size_t leaf_points = 0;  ///< largest number of points in one base case; 0: chosen by D and n
  Division division = Division::kLeastBorder;
  unsigned children = 2;  ///< parts that are merged at a time
  Kernel kernel = Kernel::kSpillway;
  /// If set, is told after each base case how many points have been through one. Called by many
  /// threads at once.
  std::function<void(std::size_t points)> progress = nullptr;
  Task* tasks = nullptr;  ///< if set, receives the tree of tasks with their durations
  /// Looked at before each task: once a stop is requested no further one begins.
  std::stop_token stop{};
  WorkLease* memory = nullptr;  ///< as in BaseCaseInput
};

/// The Delaunay triangulation of all points, exact, ties broken as src/geometry/predicates.h says:
/// Algorithm 1 of Funke and Sanders, "Parallel d-D Delaunay Triangulations in Shared and
/// Distributed Memory" (ALENEX 2017). Points must be finite. Equal points become one vertex,
/// numbered as the first of them in the input. The simplices and their order depend on points,
/// leaf_points, division and children, never on threads. Throws Failure for more than kMaxVertices
/// points, and Interrupted if a stop was requested in time.
template <int D>
Triangulation<D> delaunay_triangulation(std::span<const Point<D>> points,
                                        const DivideAndConquerOptions& options = {});

/// The same, of a border's points, for a caller that is itself one of the tasks of with_threads():
/// runs on its threads, divides only what is large (a border's parts are nearly all border, so that
/// merging them costs as much again), and keeps memory for the base cases to come. What it takes
/// beyond the usual for so many points `memory`, if it is set, grows by.
template <int D>
Triangulation<D> border_delaunay(SlabArray<Point<D>> points, Kernel kernel, WorkLease* memory,
                                 Task& task);

/// Keeps the memory of the simplices of a triangulation that is no longer needed for the next call
/// of delaunay_triangulation(), which at its end gives the system what it did not use. Without
/// that, a million points in space take 4 to 14 % longer. release_base_case_memory() gives all to
/// the system.
template <int D>
void recycle(Triangulation<D> used);

}  // namespace spillway::delaunay
