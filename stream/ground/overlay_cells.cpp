#include "stream/ground/overlay_cells.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>

#include "src/parallel/parallel.h"
#include "stream/ground/tile_index.h"
#include "stream/ground/triangle_list.h"

namespace spillway::stream {
namespace {

constexpr double kTrianglesOfACell = 16384;
constexpr double kMostCells = 1 << 18;
// How the memory is shared out. Vectors have room for up to twice as much as is in them.
constexpr std::uint64_t kHeldShare = 2;    // triangles in memory
constexpr std::uint64_t kJoinedShare = 4;  // those that are joined
/// Of a triangle that is joined: itself, and its box in up to three lists.
constexpr std::size_t kJoinedBytes = sizeof(Triangle) + 3 * sizeof(NumberedBox);
constexpr std::size_t kMostJoined = 65536;
constexpr std::size_t kLeastJoined = 2048;

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

std::vector<NumberedBox> boxes_of(std::span<const Triangle> triangles) {
  std::vector<NumberedBox> boxes;
  boxes.reserve(triangles.size());
  for (std::uint32_t t = 0; t < triangles.size(); ++t) boxes.push_back({box_of(triangles[t]), t});
  return boxes;
}

/// Finds all pairs of boxes that meet, one of each of two sets, by halving the plane as often as
/// it pays. A pair belongs to the half that has the lower left corner of what both have in common.
class PairSearch {
 public:
  /// Told that corner, and the numbers of both.
  using Found = std::function<void(const Point<2>& corner, std::uint32_t a, std::uint32_t b)>;

  explicit PairSearch(Found found) : found_(std::move(found)) {}

  void search(std::vector<NumberedBox> a, std::vector<NumberedBox> b) {
    search(std::move(a), std::move(b), whole_space<2>());
  }

 private:
  /// `region` is without its upper and right edges.
  void search(std::vector<NumberedBox> a, std::vector<NumberedBox> b, const Box<2>& region) {
    keep_those_in(box_around(b), a);
    keep_those_in(box_around(a), b);
    if (a.empty() || b.empty()) return;
    if (a.size() * b.size() > kFewPairs) {
      const Box<2> extent = box_around(a);
      const int longest = extent.longest_axis();
      for (const int axis : {longest, 1 - longest}) {
        if (halve(a, b, region, axis)) return;
      }
    }
    for (const NumberedBox& one : a) {
      for (const NumberedBox& other : b) {
        const Box<2> common = common_part(one.box, other.box);
        if (!common.empty() && holds(region, common.lo))
          found_(common.lo, one.number, other.number);
      }
    }
  }

  /// False, and nothing done, if too many boxes lie on both sides.
  bool halve(std::vector<NumberedBox>& a, std::vector<NumberedBox>& b, const Box<2>& region,
             int axis) {
    const std::vector<NumberedBox>& more = a.size() < b.size() ? b : a;
    std::vector<double> corners;
    corners.reserve(more.size());
    for (const NumberedBox& one : more) corners.push_back(one.box.lo[axis]);
    const auto middle = corners.begin() + static_cast<std::ptrdiff_t>(corners.size() / 2);
    std::ranges::nth_element(corners, middle);
    const double cut = *middle;
    std::array<std::vector<NumberedBox>, 2> low;
    std::array<std::vector<NumberedBox>, 2> high;
    for (const std::size_t set : {0, 1}) {
      for (const NumberedBox& one : set == 0 ? a : b) {
        if (one.box.lo[axis] < cut) low[set].push_back(one);
        if (one.box.hi[axis] >= cut) high[set].push_back(one);
      }
    }
    const std::size_t before = a.size() + b.size();
    const std::size_t lower = low[0].size() + low[1].size();
    const std::size_t upper = high[0].size() + high[1].size();
    if (std::max(lower, upper) == before || lower + upper > before + before / 2) return false;
    std::vector<NumberedBox>().swap(a);
    std::vector<NumberedBox>().swap(b);
    Box<2> part = region;
    part.hi[axis] = cut;
    search(std::move(low[0]), std::move(low[1]), part);
    part = region;
    part.lo[axis] = cut;
    search(std::move(high[0]), std::move(high[1]), part);
    return true;
  }

  static bool holds(const Box<2>& region, const Point<2>& p) {
    return p[0] >= region.lo[0] && p[0] < region.hi[0] && p[1] >= region.lo[1] &&
           p[1] < region.hi[1];
  }
  static Box<2> box_around(std::span<const NumberedBox> boxes) {
    Box<2> all;
    for (const NumberedBox& one : boxes) all.expand(one.box);
    return all;
  }
  static void keep_those_in(const Box<2>& box, std::vector<NumberedBox>& boxes) {
    std::erase_if(boxes, [&](const NumberedBox& one) { return common_part(one.box, box).empty(); });
  }

  static constexpr std::size_t kFewPairs = 512;

  const Found found_;
};

}  // namespace

struct OverlayCells::Cell {
  std::mutex mutex;  ///< guards the other
  std::array<TriangleList, 2> surfaces;

  [[nodiscard]] std::uint64_t held_bytes() const {
    return surfaces[0].held_bytes() + surfaces[1].held_bytes();
  }
};

OverlayCells::OverlayCells(const Box<2>& extent, std::uint64_t triangles, std::uint64_t memory,
                           unsigned threads, ScratchFolder& scratch)
    : extent_(extent),
      most_held_(memory / kHeldShare),
      joined_at_a_time_(std::clamp<std::size_t>(memory / kJoinedShare / threads / 2 / kJoinedBytes,
                                                kLeastJoined, kMostJoined)),
      spilled_(scratch, "overlay") {
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
    cell.surfaces[surface].add(some);
    held_bytes_ += some.size() * sizeof(Triangle);
  }
  if (held_bytes_ > most_held_) relieve();
}

/// Brings triangles to the disk, of the fullest cells first, until half of the memory is free.
void OverlayCells::relieve() {
  const std::unique_lock relief(relief_mutex_, std::try_to_lock);
  if (!relief) return;
  const auto held_bytes = [this](std::size_t c) {
    const std::lock_guard lock(cells_[c].mutex);
    return cells_[c].held_bytes();
  };
  spill_fullest(cells(), held_bytes, [this](std::size_t c) {
    const std::lock_guard lock(cells_[c].mutex);
    for (TriangleList& surface : cells_[c].surfaces) held_bytes_ -= surface.spill(spilled_);
    return held_bytes_ > most_held_ / 2;
  });
}

VolumeSums OverlayCells::between(const std::function<void(std::uint64_t cells)>& progress) {
  VolumeSums all;
  std::mutex mutex;
  std::uint64_t done = 0;  // guarded by mutex, as all
  parallel_for(cells(), 1, [&](std::size_t c, std::size_t, std::size_t) {
    VolumeSums sums;
    const Place place{c / columns_, c % columns_};
    const auto& [all_first, all_second] = cells_[c].surfaces;
    all_first.visit(spilled_, joined_at_a_time_, [&](std::span<const Triangle> first) {
      all_second.visit(spilled_, joined_at_a_time_, [&](std::span<const Triangle> second) {
        add_between(first, second, place, sums);
      });
    });
    const std::lock_guard lock(mutex);
    all.add(sums);
    progress(++done);
  });
  return all;
}

void OverlayCells::add_between(std::span<const Triangle> first, std::span<const Triangle> second,
                               const Place& place, VolumeSums& sums) const {
  PairSearch pairs([&](const Point<2>& corner, std::uint32_t t, std::uint32_t other) {
    if (place_of(corner) == place) terrain::add_between(first[t], second[other], sums);
  });
  pairs.search(boxes_of(first), boxes_of(second));
}

}  // namespace spillway::stream
