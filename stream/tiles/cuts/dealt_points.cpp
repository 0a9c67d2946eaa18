#include "stream/tiles/cuts/dealt_points.h"

#include <cstring>

namespace spillway::stream {

void DealtPoints::deal(const CutTree& cuts, const PointBlock& block) {
  const std::size_t count = block.points.size();
  tile_.resize(count);
  cuts.find_tiles(block.points, tile_);
  std::vector<std::size_t> next(cuts.tiles() + 1);
  for (const std::uint32_t tile : tile_) ++next[tile + 1];
  runs.clear();
  for (std::uint32_t t = 0; t < cuts.tiles(); ++t) {
    if (next[t + 1] > 0) {
      runs.push_back({t, next[t], next[t] + next[t + 1], {}});
    }
    next[t + 1] += next[t];
  }
  points.points.resize(count);
  points.index.resize(block.index.size());
  points.attributes.resize(block.attributes.size());
  const std::size_t record = block.record_size();
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t position = next[tile_[i]]++;
    points.points[position] = block.points[i];
    if (!block.index.empty()) points.index[position] = block.index[i];
    if (record > 0) {
      std::memcpy(&points.attributes[position * record], &block.attributes[i * record], record);
    }
  }
  for (PointRun& run : runs) {
    Box<3> box;
    for (std::size_t i = run.begin; i < run.end; ++i) box.expand(points.points[i]);
    run.box = box;
  }
}

}  // namespace spillway::stream
