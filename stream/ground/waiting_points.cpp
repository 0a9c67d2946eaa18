#include "stream/ground/waiting_points.h"

#include <algorithm>
#include <numeric>
#include <utility>

#include "src/parallel/parallel.h"
#include "stream/ground/triangle_list.h"
#include "stream/tiles/storage/stored_points.h"

namespace spillway::stream {
namespace {

// How the memory is shared out, beside what dealing needs, most of which it gives back.
constexpr double kBufferShare = 0.5;         // of what a plan has for points that wait
constexpr std::uint64_t kTriangleShare = 4;  // a quarter: triangles that wait
constexpr std::uint64_t kLoadedShare = 5;    // the tiles that threads have loaded
constexpr std::uint64_t kRestShare = 10;     // points that were loaded before
constexpr std::uint64_t kHeightShare = 10;   // heights that were found

constexpr std::size_t kMostTilePoints = 65536;
constexpr std::size_t kLeastTilePoints = 2048;
/// Of a point while its tile is loaded: encoded, as a place, in the grid, and its height.
constexpr std::size_t kLoadedBytes =
    2 * sizeof(NumberedPlace) + UnlocatedPoints::kPlaceBytes + sizeof(NumberedHeight);
/// More tiles than this are not made if larger ones will do: something is known of each.
constexpr std::uint64_t kManyTiles = 8192;
/// It pays to load a tile for this many triangles, and for half as many as it has points.
constexpr std::size_t kLeastTriangles = 1024;
constexpr std::size_t kTrianglesAtATime = 4096;
/// Triangles that come together and reach into no more tiles lie together.
constexpr std::size_t kFewTiles = 16;
/// Of those on the disk so many are read at a time.
constexpr std::size_t kReadAtATime = 16384;

std::size_t tile_points_for(const WaitingPointsOptions& options) {
  const std::size_t room = options.memory / kLoadedShare / options.threads / kLoadedBytes;
  const auto wanted =
      std::max<std::uint64_t>(kMostTilePoints, options.expected.value_or(0) / kManyTiles);
  return std::max<std::size_t>(kLeastTilePoints, std::min<std::uint64_t>(wanted, room));
}

/// On which sides of a box a point lies, as bits. Of a triangle whose corners have one in common no
/// point lies in the box.
std::uint8_t sides_of(const Box<2>& box, const PlacedPoint& p) {
  return static_cast<std::uint8_t>((p[0] < box.lo[0] ? 1 : 0) | (p[0] > box.hi[0] ? 2 : 0) |
                                   (p[1] < box.lo[1] ? 4 : 0) | (p[1] > box.hi[1] ? 8 : 0));
}

}  // namespace

/// Triangles that come together.
struct WaitingPoints::Block {
  std::span<const PlacedPoint> vertices;
  std::span<const std::uint32_t> corners;

  [[nodiscard]] std::size_t size() const { return corners.size() / 3; }
  [[nodiscard]] const PlacedPoint& corner(std::size_t triangle, std::size_t c) const {
    return vertices[corners[3 * triangle + c]];
  }
  [[nodiscard]] Triangle triangle(std::size_t t) const {
    return {corner(t, 0).numbers(), corner(t, 1).numbers(), corner(t, 2).numbers()};
  }
  [[nodiscard]] Box<2> box(std::size_t t) const {
    Box<2> box;
    for (std::size_t c = 0; c < 3; ++c) box.expand(Point<2>{corner(t, c)[0], corner(t, c)[1]});
    return box;
  }
};

/// What a thread needs to locate the points of a tile.
struct WaitingPoints::Workspace {
  std::vector<NumberedPlace> places;
  UnlocatedPoints points;
  std::vector<NumberedPlace> rest;
  std::vector<NumberedHeight> found;
};

/// What waits at a tile. Whoever has both mutexes locked `places_mutex` first.
struct WaitingPoints::Tile {
  /// Places on the disk.
  struct Spilled {
    std::uint64_t offset = 0;
    std::size_t count = 0;
  };

  std::mutex mutex;  ///< guards the next one
  TriangleList triangles;

  Box<2> box;
  std::atomic<std::uint64_t> unlocated = 0;  ///< points
  std::mutex places_mutex;                   ///< guards the others: held while points are located
  const TileNode<2>* stored = nullptr;       ///< where the points are, before they are first loaded
  std::vector<NumberedPlace> rest;           ///< ... and then here, and on the disk
  std::vector<Spilled> spilled_rest;

  /// How many triangles have to wait until it pays.
  [[nodiscard]] std::size_t enough() const {
    return std::max<std::size_t>(kLeastTriangles, unlocated / 2);
  }
};

WaitingPoints::WaitingPoints(const WaitingPointsOptions& options, ScratchFolder& scratch)
    : memory_(options.memory),
      plan_(plan_memory(options.memory, 2, options.threads, options.whole)),
      tile_points_(tile_points_for(options)),
      scratch_(scratch),
      spilled_(scratch, "waiting") {
  tree_.emplace(TileTreeOptions{.dimension = 2,
                                .capacity = tile_points_,
                                .buffered_points = static_cast<std::size_t>(
                                    static_cast<double>(plan_.buffered_points) * kBufferShare),
                                .expected = options.expected,
                                .extent = options.extent,
                                .index = true,
                                .batches = plan_.batches},
                scratch_, times_, watch_);
}

WaitingPoints::~WaitingPoints() = default;

void WaitingPoints::deal(PointFeed& points, const std::function<std::uint64_t()>& numbers) {
  tree_->fill(points);
  if (tree_->points_to_divide() > 0) tree_->divide_large();
  heights_ = std::make_unique<GroundHeights>(numbers(), memory_ / kHeightShare, scratch_);
  root_ = tree_->take_nodes<2>();
  if (!root_) return;
  index_ = TileIndex(*root_);
  tiles_ = std::make_unique<Tile[]>(index_.tiles().size());
  for (std::size_t t = 0; t < index_.tiles().size(); ++t) {
    tiles_[t].stored = index_.tiles()[t];
    tiles_[t].box = index_.tiles()[t]->box;
    tiles_[t].unlocated = index_.tiles()[t]->points;
  }
}

void WaitingPoints::add(std::span<const PlacedPoint> vertices,
                        std::span<const std::uint32_t> corners) {
  if (corners.empty()) return;
  const Block block{vertices, corners};
  Box<2> box;
  for (const std::uint32_t v : corners) box.expand(Point<2>{vertices[v][0], vertices[v][1]});
  const std::vector<std::uint32_t> tiles = index_.tiles_in(box);
  // Isolated: the caller may hold what another of its tasks would wait for.
  isolated([&] {
    if (tiles.size() <= kFewTiles) {
      add_coherent(block, tiles);
    } else {
      add_scattered(block);
    }
  });
  if (triangle_bytes_ > memory_ / kTriangleShare) relieve();
}

/// Triangles that lie together: where enough of them have come, they need not wait.
void WaitingPoints::add_coherent(const Block& block, std::span<const std::uint32_t> tiles) {
  parallel_for(tiles.size(), 1, [&](std::size_t i, std::size_t, std::size_t) {
    Tile& tile = tiles_[tiles[i]];
    if (tile.unlocated == 0) return;
    std::vector<std::uint8_t> sides;
    sides.reserve(block.vertices.size());
    for (const PlacedPoint& p : block.vertices) sides.push_back(sides_of(tile.box, p));
    std::vector<std::uint32_t> numbers;
    for (std::size_t t = 0; t < block.size(); ++t) {
      const std::uint32_t* const v = &block.corners[3 * t];
      if ((sides[v[0]] & sides[v[1]] & sides[v[2]]) == 0) {
        numbers.push_back(static_cast<std::uint32_t>(t));
      }
    }
    wait_at(tile, block, numbers);
  });
}

void WaitingPoints::add_scattered(const Block& block) {
  const auto add_some = [&](std::size_t /*grain*/, std::size_t begin, std::size_t end) {
    std::vector<NumberedBox> boxes;
    boxes.reserve(end - begin);
    for (std::size_t t = begin; t < end; ++t) {
      boxes.push_back({block.box(t), static_cast<std::uint32_t>(t)});
    }
    std::vector<std::uint32_t> numbers;
    index_.visit(boxes, [&](std::uint32_t tile, std::span<const NumberedBox> some) {
      if (tiles_[tile].unlocated == 0) return;
      numbers.clear();
      for (const NumberedBox& one : some) numbers.push_back(one.number);
      wait_at(tiles_[tile], block, numbers);
    });
  };
  parallel_for(block.size(), kTrianglesAtATime, add_some);
}

void WaitingPoints::wait_at(Tile& tile, const Block& block,
                            std::span<const std::uint32_t> numbers) {
  if (numbers.empty()) return;
  {
    const std::lock_guard lock(tile.mutex);
    if (tile.triangles.size() + numbers.size() < tile.enough()) {
      for (const std::uint32_t t : numbers) tile.triangles.add(block.triangle(t));
      triangle_bytes_ += numbers.size() * sizeof(Triangle);
      return;
    }
  }
  locate(tile, block, numbers);
}

/// Looks for the tile's points in these triangles and in those that wait at it.
void WaitingPoints::locate(Tile& tile, const Block& block, std::span<const std::uint32_t> numbers) {
  const std::lock_guard busy(tile.places_mutex);
  TriangleList triangles;
  {
    const std::lock_guard lock(tile.mutex);
    std::swap(triangles, tile.triangles);
  }
  std::unique_ptr<Workspace> work = take_workspace();
  UnlocatedPoints& points = work->points;
  std::vector<NumberedHeight>& found = work->found;
  std::uint64_t unlocated = 0;
  visit_places(tile, *work, [&] {
    points.assign(work->places);
    found.clear();
    for (const std::uint32_t t : numbers) points.take_located(block.triangle(t), found);
    triangles.visit(spilled_, kReadAtATime, [&](std::span<const Triangle> some) {
      for (const Triangle& triangle : some) points.take_located(triangle, found);
    });
    work->rest.clear();
    points.append_to(work->rest);
    keep_rest(tile, work->rest);
    unlocated += work->rest.size();
    located_ += found.size();
    heights_->add(found);
  });
  give_back(std::move(work));
  triangle_bytes_ -= triangles.held_bytes();
  tile.unlocated = unlocated;
}

/// Brings the places of a tile that are not located, some at a time, to `work.places`.
void WaitingPoints::visit_places(Tile& tile, Workspace& work, const std::function<void()>& visit) {
  std::vector<NumberedPlace>& places = work.places;
  places.clear();
  if (const TileNode<2>* const node = std::exchange(tile.stored, nullptr)) {
    StoredTile stored;
    {
      const std::lock_guard lock(loader_mutex_);
      stored = tree_->loader().read(*node);
    }
    const auto give = [&] {
      visit();
      places.clear();
    };
    drain_points(stored, [&](const PointsView& some) {
      for (std::size_t i = 0; i < some.size(); ++i) {
        if (places.size() == tile_points_) give();
        places.push_back({some.points[i][0], some.points[i][1], some.index[i]});
      }
    });
    if (!places.empty()) give();
    return;
  }
  const std::vector<NumberedPlace> rest = std::exchange(tile.rest, {});
  rest_bytes_ -= std::span(rest).size_bytes();
  if (!rest.empty()) {
    places.assign(rest.begin(), rest.end());
    visit();
  }
  for (const auto& [offset, count] : std::exchange(tile.spilled_rest, {})) {
    places.resize(count);
    spilled_.read(offset, std::as_writable_bytes(std::span(places)));
    visit();
  }
}

std::unique_ptr<WaitingPoints::Workspace> WaitingPoints::take_workspace() {
  const std::lock_guard lock(workspaces_mutex_);
  if (workspaces_.empty()) return std::make_unique<Workspace>();
  std::unique_ptr<Workspace> workspace = std::move(workspaces_.back());
  workspaces_.pop_back();
  return workspace;
}

void WaitingPoints::give_back(std::unique_ptr<Workspace> workspace) {
  const std::lock_guard lock(workspaces_mutex_);
  workspaces_.push_back(std::move(workspace));
}

void WaitingPoints::keep_rest(Tile& tile, std::span<const NumberedPlace> rest) {
  if (rest.empty()) return;
  if (rest_bytes_ + rest.size_bytes() > memory_ / kRestShare) {
    tile.spilled_rest.push_back({spilled_.append(std::as_bytes(rest)), rest.size()});
    return;
  }
  tile.rest.insert(tile.rest.end(), rest.begin(), rest.end());
  rest_bytes_ += rest.size_bytes();
}

/// Brings triangles to the disk, of the tiles where most wait first, until half of their room is
/// free.
void WaitingPoints::relieve() {
  const std::unique_lock relief(relief_mutex_, std::try_to_lock);
  if (!relief) return;
  const auto held_bytes = [this](std::size_t t) {
    const std::lock_guard lock(tiles_[t].mutex);
    return tiles_[t].triangles.held_bytes();
  };
  spill_fullest(index_.tiles().size(), held_bytes, [this](std::size_t t) {
    const std::lock_guard lock(tiles_[t].mutex);
    triangle_bytes_ -= tiles_[t].triangles.spill(spilled_);
    return triangle_bytes_ > memory_ / kTriangleShare / 2;
  });
}

void WaitingPoints::finish(const std::function<void(std::uint64_t points)>& progress) {
  std::mutex mutex;
  std::uint64_t done = 0;  // guarded by mutex
  parallel_for(index_.tiles().size(), 1, [&](std::size_t t, std::size_t, std::size_t) {
    Tile& tile = tiles_[t];
    if (tile.triangles.size() > 0 && tile.unlocated > 0) locate(tile, {}, {});
    const std::lock_guard lock(mutex);
    progress(done += index_.tiles()[t]->points);
  });
}

std::uint64_t WaitingPoints::spilled_bytes() const {
  return tree_->bytes_written() + spilled_.size();
}

}  // namespace spillway::stream
