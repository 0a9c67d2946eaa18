#include "stream/tiles/storage/tile_segment.h"

#include <algorithm>
#include <iterator>
#include <optional>

namespace spillway::stream {
namespace {

bool side_by_side(const TileSegment& a, const TileSegment& b) {
  return &a.stretch->file() == &b.stretch->file() && a.end_spill == b.first_spill;
}

/// How much is lost by joining two segments: many points that no longer tell where they are.
double loss(const TileSegment& a, const TileSegment& b, const Box<3>& all, int dimension) {
  Box<3> both = a.box;
  both.expand(b.box);
  double reach = 0;
  for (int k = 0; k < dimension; ++k) {
    if (all.extent(k) > 0) reach += both.extent(k) / all.extent(k);
  }
  return reach * static_cast<double>(a.points + b.points);
}

/// Makes one segment of two that lie side by side.
void join(TileSegment& segment, const TileSegment& next) {
  next.stretch->join(segment.stretch);
  segment.end_spill = next.end_spill;
  segment.points += next.points;
  segment.box.expand(next.box);
  const bool both = !segment.sketches.empty() && !next.sketches.empty();
  if (!both) return segment.sketches.clear();
  segment.sketches.insert(segment.sketches.end(), next.sketches.begin(), next.sketches.end());
}

}  // namespace

void FileStretch::append(std::span<const std::byte> bytes, std::mutex& mutex) {
  const std::uint64_t end = file_->size();
  file_->append(bytes);
  const std::lock_guard lock(mutex);
  count(end, bytes.size());
}

void FileStretch::count(std::uint64_t offset, std::uint64_t bytes) {
  if (joined_) return joined_->count(offset, bytes);
  if (size_ == 0) offset_ = offset;
  size_ += bytes;
}

void FileStretch::join(const std::shared_ptr<FileStretch>& before) {
  if (size_ > 0) before->count(offset_, size_);
  joined_ = before;
}

void join_segments(std::vector<TileSegment>& segments, std::size_t most, int dimension) {
  Box<3> all;
  for (const TileSegment& segment : segments) all.expand(segment.box);
  while (segments.size() > most) {
    std::optional<std::size_t> best;
    double least = 0;
    for (std::size_t i = 0; i + 1 < segments.size(); ++i) {
      if (!side_by_side(segments[i], segments[i + 1])) continue;
      const double lost = loss(segments[i], segments[i + 1], all, dimension);
      if (best && lost >= least) continue;
      best = i;
      least = lost;
    }
    if (!best) return;
    join(segments[*best], segments[*best + 1]);
    segments.erase(segments.begin() + static_cast<std::ptrdiff_t>(*best) + 1);
  }
}

void join_all_segments(std::vector<TileSegment>& segments,
                       const std::function<bool(std::uint64_t, std::uint64_t)>& apart) {
  std::vector<TileSegment> joined;
  for (TileSegment& segment : segments) {
    if (!joined.empty() && side_by_side(joined.back(), segment) &&
        !apart(joined.back().arrival, segment.arrival)) {
      join(joined.back(), segment);
    } else {
      joined.push_back(std::move(segment));
    }
  }
  segments = std::vector<TileSegment>(std::make_move_iterator(joined.begin()),
                                      std::make_move_iterator(joined.end()));
}

}  // namespace spillway::stream
