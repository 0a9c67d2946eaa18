#pragma once
// Incremental insertion (Bowyer, Watson) of points in space: the cells that a new point is in
// conflict with are found from those already known, neighbour by neighbour, and the hole is filled
// with the star of the point, whose spheres are made several at a time and tested with the next
// point at once.

#include <array>
#include <cstdint>
#include <utility>
#include <vector>

#include "src/delaunay/kernel_3d/cells.h"
#include "src/delaunay/kernel_3d/spheres.h"
#include "src/delaunay/kernel_3d/star_maker.h"
#include "src/delaunay/kernel_3d/working_points.h"
#include "src/delaunay/kernel_common/insertion_rounds.h"
#include "src/delaunay/kernel_common/lanes.h"
#include "src/delaunay/kernel_common/record_memory.h"

/// For functions that use the 32 vector registers of AVX-512.
#define SPILLWAY_TARGET_32_REGISTERS SPILLWAY_TARGET("avx2,bmi,bmi2,avx512f,avx512vl,avx512dq")

namespace spillway::delaunay::kernel_3d {

using CellMemory = kernel::RecordMemory<CellArray>;

/// The cells of a hole, and the facets that are its boundary.
struct HoleLists {
  Handle* cells;
  std::size_t cell_count;
  Handle* facets;  ///< of cells of the hole
  Handle* outer;   ///< the same facets in the cells around
  std::size_t facet_count;
};

/// Builds the triangulation point by point. kHasOrderKeys says what WorkingPoints::has_order_keys
/// does.
template <bool kHasOrderKeys>
class Insertion {
 public:
  /// Starts with the cell of four points that are not coplanar. `width` is what
  /// lane_width() says.
  Insertion(const WorkingPoints& points, CellMemory memory, const std::array<VertexId, 4>& first,
            int width);

  /// Inserts a point. `next` is the one that will come next.
  void insert(VertexId point, VertexId next);

  /// So many points, spread evenly over all, are inserted now, or all but the last one of them.
  void end_round(std::size_t points) { before_ = std::exchange(sample_, {points, cell_count_}); }

  /// Moves the last cells to where cells are free, so that those that are left, simplex_count()
  /// of them, infinite ones included, fill the array from its beginning.
  void close_gaps();

  /// Of the cells' memory, by the samples that the rounds have left.
  [[nodiscard]] WorkForecast forecast() const;

  [[nodiscard]] std::uint32_t simplex_count() const { return cell_count_; }
  [[nodiscard]] const CellArray& simplices() const { return cells_; }
  [[nodiscard]] const std::vector<kernel::Repetition>& repetitions() const { return repetitions_; }

 private:
  static constexpr std::size_t kFirstListSize = 512;
  /// Room after the ends of lists, for what is written ahead.
  static constexpr std::size_t kAhead = 16;
  /// Known conflicts for which there are bits, and room in the shortest lists for what is around.
  static constexpr std::size_t kMostKnown = 64;
  static_assert(4 * kMostKnown + kAhead <= kFirstListSize);

  /// The same, for each instruction set.
  void insert_by_2(VertexRef query, VertexRef next);
  void insert_by_4(VertexRef query, VertexRef next);
  SPILLWAY_TARGET_32_REGISTERS void insert_by_4_with_32_registers(VertexRef query, VertexRef next);
  template <int kLanes>
  void insert_by(VertexRef query, VertexRef next);

  Handle locate(VertexRef query);
  Handle locate_exactly(VertexRef query, Handle first);
  template <int kLanes>
  HoleLists find_hole(VertexRef query, std::size_t known);
  template <int kLanes>
  void leave_star(std::size_t known, HoleLists& hole);
  template <int kLanes>
  std::uint32_t decide(const Cell& cell, std::uint32_t doubtful, VertexRef query) const;
  bool conflicts(Handle first, VertexRef query) const;
  /// Whether it is certain that a query within the tolerance is on the cell's sphere.
  static bool tie_is_noted(const Cell& cell) {
    return kHasOrderKeys && notes_tie(cell.squared_radius);
  }
  template <int kLanes>
  bool noted_tie_conflicts(const Cell& cell, VertexRef query) const;

  template <int kLanes>
  void take_cells(const HoleLists& hole);
  template <int kLanes>
  void make_star_spheres(VertexRef query, VertexRef next, std::size_t count, bool on_hull);
  template <int kLanes>
  void look_beyond_star(const double* next, std::size_t known);
  std::size_t make_half_spaces(VertexRef next, std::size_t count, std::size_t known);
  void make_half_space(Cell& cell) const;
  void choose_hint(const double* next, std::size_t count);

  void resize_lists(std::size_t size);
  HoleLists hole_lists(std::size_t cell_count, std::size_t facet_count) {
    return {conflicts_.data(), cell_count, boundary_.data(), outer_.data(), facet_count};
  }
  void grow_cells(std::size_t count);

  const WorkingPoints points_;
  CellMemory memory_;
  CellArray cells_;
  std::size_t capacity_;
  const int width_;
  std::uint32_t cell_count_ = 5;
  std::size_t free_count_ = 0;
  SampleSize sample_{.points = 4, .simplices = 5};
  SampleSize before_ = sample_;      ///< the one before that
  std::size_t known_conflicts_ = 0;  ///< at the beginning of conflicts_, of the next point
  /// Whether they are all there are in the newest star, and all cells beside them are tested.
  bool star_is_certain_ = false;
  std::uint64_t outer_in_conflict_ = 0;  ///< for each known one, whether that beyond the star is
  Handle hint_ = 0;                      ///< a cell near the next point, if none is known

  std::vector<Handle> conflicts_;  ///< the cells of the hole
  std::vector<Handle> boundary_;   ///< the facets of the hole
  std::vector<Handle> outer_;      ///< the same facets in the cells around
  std::vector<Handle> free_;
  std::vector<Handle> star_;  ///< the new cells, one for each facet
  StarMaker star_maker_;
  std::vector<kernel::Repetition> repetitions_;
};

extern template class Insertion<false>;
extern template class Insertion<true>;

}  // namespace spillway::delaunay::kernel_3d
