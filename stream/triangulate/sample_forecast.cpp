#include "stream/triangulate/sample_forecast.h"

#include <algorithm>
#include <numeric>

#include "src/delaunay/base_case/base_case.h"
#include "src/geometry/dimensions.h"

namespace spillway::stream {
namespace {

/// Enough to tell the exponent; at worst they make as many simplices as pairs, in 1 MiB.
constexpr std::size_t kSample = 128;
constexpr std::size_t kPart = 4;  ///< of the sample, which is compared with all of it

/// What one of very many takes in a base case.
constexpr double kBytesOfSimplex = 80;

/// Simplices of every `stride`-th point.
template <int D>
std::size_t count_simplices(std::span<const Point<D>> sample, std::size_t stride) {
  std::vector<Point<D>> points;
  for (std::size_t i = 0; i < sample.size(); i += stride) points.push_back(sample[i]);
  std::vector<VertexId> index(points.size());
  std::iota(index.begin(), index.end(), VertexId{0});
  return triangulate_base_case<D>({.points = points, .input_index = index}).simplices.size();
}

}  // namespace

template <int D>
void SampleForecast<D>::note(std::span<const Point<D>> tile) {
  const std::lock_guard lock(mutex_);
  if (tile.size() <= tile_points_) return;
  tile_points_ = tile.size();
  sample_.clear();
  const std::size_t count = std::min(kSample, tile.size());
  for (std::size_t i = 0; i < count; ++i) sample_.push_back(tile[i * tile.size() / count]);
}

template <int D>
WorkForecast SampleForecast<D>::forecast() const {
  const std::lock_guard lock(mutex_);
  if (sample_.empty()) return {};
  return WorkForecast::of(
      {.points = sample_.size() / kPart, .simplices = count_simplices<D>(sample_, kPart)},
      {.points = sample_.size(), .simplices = count_simplices<D>(sample_, 1)}, D, kBytesOfSimplex);
}

#define SPILLWAY_INSTANTIATE(D) template class SampleForecast<D>;
SPILLWAY_FOR_EACH_DIMENSION(SPILLWAY_INSTANTIATE)
#undef SPILLWAY_INSTANTIATE

}  // namespace spillway::stream
