#pragma once
// Incremental insertion (Bowyer, Watson) of points in more than three dimensions: the simplices
// that a new point is in conflict with are found neighbour by neighbour, and the hole that they
// leave is filled with the star of the point.

#include <array>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "src/delaunay/kernel_common/insertion_rounds.h"
#include "src/delaunay/kernel_common/record_memory.h"
#include "src/delaunay/kernel_nd/ridge_table.h"
#include "src/delaunay/kernel_nd/simplices.h"
#include "src/delaunay/kernel_nd/working_points.h"
#include "src/runtime/work_forecast.h"

namespace spillway::delaunay::kernel_nd {

template <int D>
using SimplexMemory = kernel::RecordMemory<SimplexArray<D>>;

/// Builds the triangulation point by point.
template <int D>
class Insertion {
 public:
  /// Starts with the simplex of D + 1 points that span D dimensions. `width` is what lane_width()
  /// says.
  Insertion(const WorkingPoints<D>& points, SimplexMemory<D> memory,
            const std::array<VertexId, D + 1>& first, int width);

  /// Inserts a point. `next` is the one that will come next.
  void insert(VertexId point, VertexId next);

  /// So many points, spread evenly over all, are inserted now, or all but the last one of them.
  void end_round(std::size_t points) {
    before_ = std::exchange(sample_, {points, count_ - free_.size()});
  }

  /// Moves the last simplices to where others are free, so that those that are left,
  /// simplex_count() of them, infinite ones included, fill the array from its beginning.
  void close_gaps();

  /// Of the memory of simplices, by the samples that the rounds have left.
  [[nodiscard]] WorkForecast forecast() const;

  [[nodiscard]] std::uint32_t simplex_count() const { return count_; }
  [[nodiscard]] const SimplexArray<D>& simplices() const { return simplices_; }
  [[nodiscard]] const std::vector<kernel::Repetition>& repetitions() const { return repetitions_; }

 private:
  using Record = SimplexRecord<D>;
  static constexpr std::uint32_t kNone = ~std::uint32_t{0};
  /// Of a hole, what is beside its simplices is fetched so many ahead.
  static constexpr std::size_t kAhead = 8;

  void start(std::array<VertexId, D + 1> first);
  std::uint32_t locate(VertexId query);
  std::uint32_t locate_exactly(VertexId query, std::uint32_t number);
  [[nodiscard]] bool is_in_conflict(const Record& simplex, VertexId query) const;
  [[nodiscard]] bool is_in_conflict_exactly(const Record& simplex, VertexId query) const;
  [[nodiscard]] std::array<Point<D>, D + 1> corners_of(
      const std::array<VertexId, D + 1>& vertices) const;
  [[nodiscard]] int orientation_with(const Record& simplex, int slot, VertexId query) const;
  void find_hole(VertexId query, std::uint32_t first);
  void prefetch_neighbours(std::uint32_t number) const {
    for (const Facet next : simplices_.record(number).neighbours) {
      __builtin_prefetch(&simplices_.at(next).power);
      __builtin_prefetch(&simplices_.at(next).mark);
    }
  }
  void take_numbers(std::size_t count);
  void fill_hole(VertexId query);
  void join_star();
  template <typename Table, typename ForEachRidge>
  void join_star(Table& table, const ForEachRidge& for_each);
  void make_star_powers();
  void make_star_powers_by_4();
  void free_hole();
  void choose_hint(VertexId next);

  const WorkingPoints<D> points_;
  SimplexMemory<D> memory_;
  SimplexArray<D> simplices_;
  std::size_t capacity_ = 0;
  const int width_;
  std::uint32_t count_ = 0;  ///< of numbers, those that are free included
  SampleSize sample_{.points = D + 1, .simplices = D + 2};
  SampleSize before_ = sample_;  ///< the one before that
  std::uint32_t search_ = 0;     ///< mark of those in the hole
  std::uint32_t hint_ = 0;       ///< a simplex near the next point

  std::vector<std::uint32_t> hole_;
  std::vector<Facet> boundary_;      ///< of the hole, as facets of its simplices
  std::vector<std::uint32_t> star_;  ///< the new simplices, one for each of these
  std::vector<std::uint32_t> free_;
  StarVertices star_vertices_;
  std::vector<std::array<std::uint32_t, D>> star_numbers_;  ///< of the vertices of each simplex
  bool star_on_hull_ = false;                               ///< whether some are infinite
  RidgeTable<std::uint64_t> ridges_;
  RidgeTable<Bits128> wide_ridges_;  ///< of stars with many vertices
  std::vector<kernel::Repetition> repetitions_;
};

}  // namespace spillway::delaunay::kernel_nd
