#include "stream/ground/repeated_points.h"

#include <algorithm>
#include <numeric>

#include "src/error.h"
#include "stream/points/encoded_points.h"

namespace spillway::stream {

RepeatedPoints::RepeatedPoints(PointStream& points, bool can_read_again, ScratchFolder& scratch,
                               RepeatedIndex index)
    : points_(points), index_(index), scratch_(can_read_again ? nullptr : &scratch) {}

void RepeatedPoints::repeat() {
  repeats_ = true;
  if (is_kept()) {
    std::ranges::sort(kept_, {}, &Kept::first);
    next_ = 0;
    return;
  }
  numbers_ = 0;
  points_.read_again(false);
}

bool RepeatedPoints::fetch(SourcePiece& piece) {
  if (repeats_ && is_kept()) {
    if (next_ == kept_.size()) return false;
    const Kept& kept = kept_[next_++];
    piece.raw.clear();
    piece.arrival = kept.first;
    piece.raw.offset = kept.offset;
    piece.raw.bytes.resize(kept.size);
    file_->read(kept.offset, piece.raw.bytes);
    return true;
  }
  if (!points_.fetch(piece)) return false;
  piece.arrival = numbers_;
  numbers_ += piece.raw.records();
  return true;
}

void RepeatedPoints::decode(SourcePiece& piece, PointBlock& block) {
  const std::uint64_t first = piece.arrival;
  if (repeats_ && is_kept()) {
    block.clear();
    decode_all_points(piece.raw.bytes, FileSpot{file_->name(), at_byte(piece.raw.offset)}, block);
  } else {
    points_.decode(piece, block);
  }
  if (index_ == RepeatedIndex::kNumber) {
    block.index.resize(block.size());
    std::iota(block.index.begin(), block.index.end(), first);
  }
  if (!repeats_ && is_kept() && block.size() > 0) keep(first, block);
}

void RepeatedPoints::keep(std::uint64_t first, const PointBlock& block) {
  PointsView points = PointsView::of(block);
  if (index_ == RepeatedIndex::kNumber) points.index = {};
  std::vector<std::byte> bytes;
  append_all_points(bytes, points);
  const std::lock_guard lock(mutex_);
  if (!file_) file_ = scratch_->create("points");
  kept_.push_back({first, file_->size(), bytes.size()});
  file_->append(bytes);
}

std::uint64_t RepeatedPoints::points_read() const {
  return repeats_ && is_kept() && next_ < kept_.size() ? kept_[next_].first : points_.points_read();
}

std::optional<double> RepeatedPoints::fraction_read() const {
  if (!repeats_ || !is_kept()) return points_.fraction_read();
  return kept_.empty() ? 1.0 : static_cast<double>(next_) / static_cast<double>(kept_.size());
}

}  // namespace spillway::stream
