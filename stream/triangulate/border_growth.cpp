#include "stream/triangulate/border_growth.h"

#include <algorithm>
#include <cmath>

#include "src/geometry/dimensions.h"
#include "stream/tiles/storage/tile_points.h"

namespace spillway::stream {
namespace {

/// Fewer tiles don't tell how borders grow.
constexpr std::uint64_t kTellingTiles = 8;

/// What is added to an estimate.
constexpr double kReserve = 1.2;

/// What a tile takes beside its points, at least, as a share of the limit; and what it may take at
/// most, for a larger limit to help.
constexpr double kLeastTileWork = 0.1;
constexpr double kMostTileShare = 0.75;

}  // namespace

template <int D>
void BorderGrowth<D>::add_tile(std::uint64_t points, const Border<D>& border) {
  const std::lock_guard lock(mutex_);
  ++tiles_;
  points_ += points;
  tile_bytes_ += border.bytes();
  tile_vertices_ += border.vertices.size();
  most_bytes_ = std::max(most_bytes_, bytes_ += border.bytes());
}

template <int D>
void BorderGrowth<D>::begin_merge(std::uint64_t points, std::span<const Border<D>> children) {
  Merge merge{.thread = std::this_thread::get_id(), .points = points};
  std::uint64_t vertices = 0;
  for (const Border<D>& child : children) {
    merge.bytes += child.bytes();
    vertices += child.vertices.size();
  }
  merge.triangulated = merge_bytes<D>(vertices, points);
  const std::lock_guard lock(mutex_);
  under_way_.push_back(merge);
}

template <int D>
void BorderGrowth<D>::end_merge(std::uint64_t triangulated, const Border<D>& border) {
  const std::lock_guard lock(mutex_);
  const auto merge = merge_of_this_thread();
  const std::uint64_t taken = merge->bytes + merge_bytes<D>(triangulated, merge->points);
  if (taken > most_merge_) {
    most_merge_ = taken;
    most_merge_points_ = merge->points;
  }
  bytes_ -= merge->bytes;
  most_bytes_ = std::max(most_bytes_, bytes_ += border.bytes());
  under_way_.erase(merge);
}

/// The caller holds the mutex.
template <int D>
auto BorderGrowth<D>::merge_of_this_thread() const {
  return std::ranges::find(under_way_, std::this_thread::get_id(), &Merge::thread);
}

/// Of what is in memory at a time, over the points that are done. 1 where merges of tiles make
/// nothing final.
template <int D>
double BorderGrowth<D>::growth_exponent() const {
  if (tiles_ < kTellingTiles || tile_bytes_ == 0) return 1;
  const double tiles = static_cast<double>(tiles_);
  const double of_one = static_cast<double>(tile_bytes_) / tiles;
  const double measured = std::log(static_cast<double>(most_bytes_) / of_one) / std::log(tiles);
  return std::clamp(measured, 1 - 1.0 / D, 1.0);
}

template <int D>
std::uint64_t BorderGrowth<D>::enough_for(const Shortage& shortage) const {
  const std::lock_guard lock(mutex_);
  if (tile_vertices_ >= points_ / 2) {
    const double all_in_borders = static_cast<double>(
        enough_memory<D>(shortage.all_points, shortage.record_size, shortage.densest));
    return static_cast<std::uint64_t>(kReserve * all_in_borders);
  }
  const auto limit = static_cast<double>(shortage.limit);
  const auto all = static_cast<double>(shortage.all_points);
  const double exponent = growth_exponent();
  const auto grown = [&](double bytes, std::uint64_t points) {
    return bytes * std::pow(std::max(1.0, all / static_cast<double>(points)), exponent);
  };
  double merge = most_merge_ > 0 ? grown(static_cast<double>(most_merge_), most_merge_points_) : 0;
  double others =
      static_cast<double>(shortage.used + shortage.refused) - static_cast<double>(bytes_);
  double refused = 0;  // what a merge of this thread takes
  const auto own = merge_of_this_thread();
  for (auto some = under_way_.begin(); some != under_way_.end(); ++some) {
    const std::uint64_t asked = some == own ? shortage.refused : some->triangulated;
    const auto taken = static_cast<double>(some->bytes + asked);
    others -= taken;
    if (some != own) continue;
    refused = taken;
    merge = std::max(merge, grown(taken, some->points));
  }
  const double resident = grown(static_cast<double>(most_bytes_), points_);
  // A merge has no more vertices than there are in memory.
  const double vertices = resident * static_cast<double>(tile_vertices_) /
                          static_cast<double>(std::max<std::uint64_t>(tile_bytes_, 1));
  const auto most_vertices = static_cast<std::uint64_t>(vertices);
  const auto most_triangulated =
      static_cast<double>(merge_bytes<D>(most_vertices, shortage.all_points));
  const double between =
      kReserve *
      (resident + std::clamp(merge, refused, std::max(refused, resident + most_triangulated)));
  const auto loaded = static_cast<double>(std::min(shortage.loaded, shortage.all_points));
  const double tiles =
      kReserve *
      std::max(others, loaded * static_cast<double>(kLoadedPointBytes + shortage.record_size) +
                           kLeastTileWork * limit);
  if (tiles > kMostTileShare * limit) return 0;
  const double of_any_size = between / (1 - tiles / limit);
  const double of_all_loaded = between + tiles * all / loaded;
  return static_cast<std::uint64_t>(std::min(of_any_size, of_all_loaded));
}

#define SPILLWAY_INSTANTIATE(D) template class BorderGrowth<D>;
SPILLWAY_FOR_EACH_DIMENSION(SPILLWAY_INSTANTIATE)
#undef SPILLWAY_INSTANTIATE

}  // namespace spillway::stream
