#include "stream/ground/overlay_cells.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>

#include "src/parallel/parallel.h"

namespace spillway::stream {
namespace {

constexpr double kTrianglesOfACell = 16384;
constexpr double kMostCells = 1 << 18;
/// So many triangles of each surface are joined at a time.
constexpr std::size_t kJoinedAtATime = 65536;
/// Triangles of a bucket, within a cell.
constexpr double kTrianglesOfABucket = 2;

Box<2> box_of(const Triangle& triangle) {
  Box<2> box;
  for (const Point<3>& corner : triangle) box.expand(Point<2>{corner[0], corner[1]});
  return box;
}

std::size_t cell_of(double distance, double extent, std::size_t cells) {
  const double cell = extent > 0 ? distance / extent * static_cast<double>(cells) : 0;
  if (!(cell > 0)) return 0;
  return cell < static_cast<double>(cells) ? static_cast<std::size_t>(cell) : cells - 1;
}

/// Rows and columns of about so many cells that are about squares.
std::pair<std::size_t, std::size_t> divided(const Box<2>& box, double cells) {
  const double width = box.extent(0);
  const double height = box.extent(1);
  if (!(width > 0) || !(height > 0)) return {1, 1};
  const double across = std::clamp(std::sqrt(cells * width / height), 1.0, cells);
  return {static_cast<std::size_t>(std::max(1.0, cells / across)),
          static_cast<std::size_t>(across)};
}

}  // namespace

struct OverlayCells::Cell {
  struct Spilled {
    std::uint64_t offset = 0;
    std::size_t count = 0;
  };
  struct Surface {
    std::vector<Triangle> triangles;
    std::vector<Spilled> spilled;
  };
  std::mutex mutex;  ///< guards the other
  std::array<Surface, 2> surfaces;
};

OverlayCells::OverlayCells(const Box<2>& extent, std::uint64_t triangles, std::uint64_t memory,
                           ScratchFolder& scratch)
    : extent_(extent), memory_(memory), spilled_(scratch, "overlay") {
  const double cells = static_cast<double>(triangles) / kTrianglesOfACell;
  std::tie(rows_, columns_) = divided(extent, std::clamp(cells, 1.0, kMostCells));
  cells_ = std::make_unique<Cell[]>(rows_ * columns_);
}

OverlayCells::~OverlayCells() = default;

OverlayCells::Place OverlayCells::place_of(const Point<2>& p) const {
  return {cell_of(p[1] - extent_.lo[1], extent_.extent(1), rows_),
          cell_of(p[0] - extent_.lo[0], extent_.extent(0), columns_)};
}

void OverlayCells::add(std::size_t surface, std::span<const Triangle> triangles) {
  std::map<std::size_t, std::vector<Triangle>> by_cell;
  for (const Triangle& triangle : triangles) {
    const Box<2> box = box_of(triangle);
    const Place first = place_of(box.lo);
    const Place last = place_of(box.hi);
    for (std::size_t row = first.row; row <= last.row; ++row) {
      for (std::size_t column = first.column; column <= last.column; ++column) {
        by_cell[row * columns_ + column].push_back(triangle);
      }
    }
  }
  for (const auto& [number, some] : by_cell) {
    Cell& cell = cells_[number];
    const std::lock_guard lock(cell.mutex);
    std::vector<Triangle>& all = cell.surfaces[surface].triangles;
    all.insert(all.end(), some.begin(), some.end());
    held_bytes_ += some.size() * sizeof(Triangle);
  }
  if (held_bytes_ > memory_) relieve();
}

/// Brings triangles to the disk, of the fullest cells first, until half of the memory is free.
void OverlayCells::relieve() {
  const std::unique_lock relief(relief_mutex_, std::try_to_lock);
  if (!relief) return;
  std::vector<std::pair<std::size_t, std::size_t>> order;
  for (std::size_t c = 0; c < cells(); ++c) {
    const std::lock_guard lock(cells_[c].mutex);
    const auto& [first, second] = cells_[c].surfaces;
    const std::size_t count = first.triangles.size() + second.triangles.size();
    if (count > 0) order.emplace_back(count, c);
  }
  std::ranges::sort(order, std::greater());
  for (const auto& [count, c] : order) {
    if (held_bytes_ <= memory_ / 2) return;
    const std::lock_guard lock(cells_[c].mutex);
    for (Cell::Surface& surface : cells_[c].surfaces) {
      const std::span<const std::byte> bytes = std::as_bytes(std::span(surface.triangles));
      if (bytes.empty()) continue;
      surface.spilled.push_back({spilled_.append(bytes), surface.triangles.size()});
      held_bytes_ -= bytes.size();
      std::vector<Triangle>().swap(surface.triangles);
    }
  }
}

/// Calls take(triangles) for all of a surface, some at a time.
void OverlayCells::visit(Cell& cell, std::size_t surface,
                         const std::function<void(std::span<const Triangle>)>& take) {
  const Cell::Surface& from = cell.surfaces[surface];
  for (std::size_t done = 0; done < from.triangles.size(); done += kJoinedAtATime) {
    take(std::span(from.triangles)
             .subspan(done, std::min(kJoinedAtATime, from.triangles.size() - done)));
  }
  std::vector<Triangle> some;
  for (const auto& [offset, count] : from.spilled) {
    for (std::size_t done = 0; done < count; done += some.size()) {
      some.resize(std::min(kJoinedAtATime, count - done));
      spilled_.read(offset + done * sizeof(Triangle), std::as_writable_bytes(std::span(some)));
      take(some);
    }
  }
}

VolumeSums OverlayCells::between(const std::function<void(std::uint64_t cells)>& progress) {
  VolumeSums all;
  std::mutex mutex;
  std::uint64_t done = 0;  // guarded by mutex, as all
  parallel_for(cells(), 1, [&](std::size_t c, std::size_t, std::size_t) {
    VolumeSums sums;
    const Place place{c / columns_, c % columns_};
    visit(cells_[c], 0, [&](std::span<const Triangle> first) {
      visit(cells_[c], 1,
            [&](std::span<const Triangle> second) { add_between(first, second, place, sums); });
    });
    const std::lock_guard lock(mutex);
    all.add(sums);
    progress(++done);
  });
  return all;
}

/// A pair of triangles whose boxes meet belongs to one cell, and to one bucket of it: those of the
/// lower left corner of what the boxes have in common.
void OverlayCells::add_between(std::span<const Triangle> first, std::span<const Triangle> second,
                               const Place& place, VolumeSums& sums) const {
  std::vector<Box<2>> boxes;
  Box<2> extent;
  for (const Triangle& triangle : first) {
    boxes.push_back(box_of(triangle));
    extent.expand(boxes.back());
  }
  const auto [rows, columns] =
      divided(extent, std::max(1.0, static_cast<double>(first.size()) / kTrianglesOfABucket));
  const auto bucket_of = [&, rows = rows, columns = columns](const Point<2>& p) {
    return Place{cell_of(p[1] - extent.lo[1], extent.extent(1), rows),
                 cell_of(p[0] - extent.lo[0], extent.extent(0), columns)};
  };
  std::vector<std::vector<std::uint32_t>> buckets(rows * columns);
  const auto visit_buckets = [&, columns = columns](const Box<2>& box, const auto& visit_bucket) {
    const Place low = bucket_of(box.lo);
    const Place high = bucket_of(box.hi);
    for (std::size_t row = low.row; row <= high.row; ++row) {
      for (std::size_t column = low.column; column <= high.column; ++column) {
        visit_bucket(Place{row, column}, buckets[row * columns + column]);
      }
    }
  };
  for (std::uint32_t t = 0; t < boxes.size(); ++t) {
    visit_buckets(boxes[t],
                  [&](const Place&, std::vector<std::uint32_t>& bucket) { bucket.push_back(t); });
  }
  for (const Triangle& other : second) {
    const Box<2> box = box_of(other);
    if (common_part(box, extent).empty()) continue;
    visit_buckets(box, [&](const Place& at, const std::vector<std::uint32_t>& bucket) {
      for (const std::uint32_t t : bucket) {
        const Box<2> common = common_part(box, boxes[t]);
        if (common.empty() || bucket_of(common.lo) != at || place_of(common.lo) != place) continue;
        terrain::add_between(first[t], other, sums);
      }
    });
  }
}

}  // namespace spillway::stream
