#include "stream/ground/waiting_points.h"

#include <algorithm>
#include <numeric>
#include <utility>

#include "src/parallel/parallel.h"
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
/// Of those on the disk so many are read at a time.
constexpr std::size_t kReadAtATime = 16384;

std::size_t tile_points_for(const WaitingPointsOptions& options) {
  const std::size_t room = options.memory / kLoadedShare / options.threads / kLoadedBytes;
  const auto wanted =
      std::max<std::uint64_t>(kMostTilePoints, options.expected.value_or(0) / kManyTiles);
  return std::max<std::size_t>(kLeastTilePoints, std::min<std::uint64_t>(wanted, room));
}

Box<2> box_of(const Triangle& triangle) {
  Box<2> box;
  for (const Point<3>& corner : triangle) box.expand(Point<2>{corner[0], corner[1]});
  return box;
}

}  // namespace

/// What waits at a tile. Whoever has both mutexes locked `places_mutex` first.
struct WaitingPoints::Tile {
  /// Triangles or places on the disk.
  struct Spilled {
    std::uint64_t offset = 0;
    std::size_t count = 0;
  };

  std::mutex mutex;  ///< guards the next three
  std::vector<Triangle> triangles;
  std::vector<Spilled> spilled;
  std::size_t waiting = 0;  ///< triangles, also on the disk

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
  heights_.emplace(numbers(), memory_ / kHeightShare, scratch_);
  root_ = tree_->take_nodes<2>();
  if (!root_) return;
  index_ = TileIndex(*root_);
  tiles_ = std::make_unique<Tile[]>(index_.tiles().size());
  for (std::size_t t = 0; t < index_.tiles().size(); ++t) {
    tiles_[t].stored = index_.tiles()[t];
    tiles_[t].unlocated = index_.tiles()[t]->points;
  }
}

void WaitingPoints::add(std::span<const PlacedPoint> vertices,
                        std::span<const std::uint32_t> corners) {
  const auto triangle_at = [&](std::size_t t) {
    return Triangle{vertices[corners[3 * t]].numbers(), vertices[corners[3 * t + 1]].numbers(),
                    vertices[corners[3 * t + 2]].numbers()};
  };
  const auto add_some = [&](std::size_t /*grain*/, std::size_t begin, std::size_t end) {
    std::vector<NumberedBox> boxes;
    boxes.reserve(end - begin);
    for (std::size_t t = begin; t < end; ++t) {
      boxes.push_back({box_of(triangle_at(t)), static_cast<std::uint32_t>(t)});
    }
    std::vector<Triangle> triangles;
    index_.visit(boxes, [&](std::uint32_t tile, std::span<const NumberedBox> some) {
      if (tiles_[tile].unlocated == 0) return;
      triangles.clear();
      for (const NumberedBox& one : some) triangles.push_back(triangle_at(one.number));
      take(tiles_[tile], triangles);
    });
  };
  // Isolated: the caller may hold what another of its tasks would wait for.
  isolated([&] { parallel_for(corners.size() / 3, kTrianglesAtATime, add_some); });
}

void WaitingPoints::take(Tile& tile, std::span<const Triangle> triangles) {
  bool enough = false;
  {
    const std::lock_guard lock(tile.mutex);
    if (tile.triangles.empty()) tile.triangles.reserve(tile.enough() + triangles.size());
    tile.triangles.insert(tile.triangles.end(), triangles.begin(), triangles.end());
    tile.waiting += triangles.size();
    enough = tile.waiting >= tile.enough();
  }
  triangle_bytes_ += triangles.size_bytes();
  if (enough) locate(tile);
  if (triangle_bytes_ > memory_ / kTriangleShare) relieve();
}

/// If another thread is at it, that one leaves what has come meanwhile to the next.
void WaitingPoints::locate(Tile& tile) {
  const std::unique_lock busy(tile.places_mutex, std::try_to_lock);
  if (!busy) return;
  std::vector<Triangle> triangles;
  std::vector<Tile::Spilled> spilled;
  {
    const std::lock_guard lock(tile.mutex);
    triangles.swap(tile.triangles);
    spilled.swap(tile.spilled);
    tile.waiting = 0;
  }
  std::uint64_t unlocated = 0;
  std::vector<NumberedPlace> rest;
  std::vector<NumberedHeight> found;
  std::vector<Triangle> some;
  visit_places(tile, [&](std::span<const NumberedPlace> places) {
    UnlocatedPoints points(places);
    found.clear();
    for (const Triangle& triangle : triangles) points.take_located(triangle, found);
    for (const auto& [offset, count] : spilled) {
      for (std::size_t done = 0; done < count && points.size() > 0; done += some.size()) {
        some.resize(std::min(count - done, kReadAtATime));
        spilled_.read(offset + done * sizeof(Triangle), std::as_writable_bytes(std::span(some)));
        for (const Triangle& triangle : some) points.take_located(triangle, found);
      }
    }
    rest.clear();
    points.append_to(rest);
    keep_rest(tile, rest);
    unlocated += rest.size();
    located_ += found.size();
    heights_->add(found);
  });
  triangle_bytes_ -= triangles.size() * sizeof(Triangle);
  tile.unlocated = unlocated;
}

void WaitingPoints::visit_places(Tile& tile,
                                 const std::function<void(std::span<const NumberedPlace>)>& visit) {
  std::vector<NumberedPlace> places;
  if (const TileNode<2>* const node = std::exchange(tile.stored, nullptr)) {
    StoredTile stored;
    {
      const std::lock_guard lock(loader_mutex_);
      stored = tree_->loader().read(*node);
    }
    const auto give = [&] {
      visit(places);
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
  if (!rest.empty()) visit(rest);
  for (const auto& [offset, count] : std::exchange(tile.spilled_rest, {})) {
    places.resize(count);
    spilled_.read(offset, std::as_writable_bytes(std::span(places)));
    visit(places);
  }
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
  std::vector<std::pair<std::size_t, std::size_t>> order;
  for (std::size_t t = 0; t < index_.tiles().size(); ++t) {
    const std::lock_guard lock(tiles_[t].mutex);
    if (!tiles_[t].triangles.empty()) order.emplace_back(tiles_[t].triangles.size(), t);
  }
  std::ranges::sort(order, std::greater());
  for (const auto& [count, t] : order) {
    if (triangle_bytes_ <= memory_ / kTriangleShare / 2) return;
    Tile& tile = tiles_[t];
    const std::lock_guard lock(tile.mutex);
    const std::span<const std::byte> bytes = std::as_bytes(std::span(tile.triangles));
    if (bytes.empty()) continue;
    tile.spilled.push_back({spilled_.append(bytes), tile.triangles.size()});
    triangle_bytes_ -= bytes.size();
    tile.triangles = {};
  }
}

void WaitingPoints::finish(const std::function<void(std::uint64_t points)>& progress) {
  std::mutex mutex;
  std::uint64_t done = 0;  // guarded by mutex
  parallel_for(index_.tiles().size(), 1, [&](std::size_t t, std::size_t, std::size_t) {
    Tile& tile = tiles_[t];
    if (tile.waiting > 0 && tile.unlocated > 0) locate(tile);
    const std::lock_guard lock(mutex);
    progress(done += index_.tiles()[t]->points);
  });
}

std::uint64_t WaitingPoints::spilled_bytes() const {
  return tree_->bytes_written() + spilled_.size() + (heights_ ? heights_->spilled_bytes() : 0);
}

}  // namespace spillway::stream
