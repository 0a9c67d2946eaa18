#include "stream/sinks/pixel_points.h"

#include <algorithm>
#include <iterator>
#include <limits>
#include <queue>
#include <string>
#include <utility>

#include "formats/blocks/block.h"
#include "formats/blocks/columns.h"
#include "formats/state/state_reader.h"
#include "formats/state/state_writer.h"
#include "src/error.h"

namespace spillway::stream {
namespace {

// Points of a run are blocks (docs/formats-blocks.md) of this kind: their pixels as a column, then
// their heights.
constexpr std::uint32_t kPixelPoints = 0x50585053;

constexpr std::size_t kBlockPoints = 2048;

/// Runs of one level that become one of the next.
constexpr std::size_t kMostRuns = 32;

/// More points than these are not sorted at a time: sorting goes on beside other threads.
constexpr std::size_t kMostWaiting = std::size_t{1} << 22;

/// Of those that wait, and of as many that are being sorted; the rest is for blocks of runs.
std::size_t points_at_a_time(std::uint64_t memory) {
  const std::uint64_t points = memory * 3 / 4 / (2 * sizeof(PointInPixel));
  return static_cast<std::size_t>(std::min<std::uint64_t>(points, kMostWaiting));
}

}  // namespace

/// Writes a run, point by point.
class PixelPoints::Writer {
 public:
  Writer(std::uint32_t level, ScratchFolder& scratch) : run_{level, {}, scratch.create("points")} {}

  void put(const PointInPixel& point) {
    pixels_.push_back(point.pixel);
    heights_.push_back(point.z);
    if (pixels_.size() == kBlockPoints) write();
  }

  [[nodiscard]] Run finish() {
    if (!pixels_.empty()) write();
    return std::move(run_);
  }

 private:
  void write() {
    std::vector<std::byte> content;
    append_column(content, pixels_);
    append_column(content, heights_);
    std::vector<std::byte> block;
    append_block(block, kPixelPoints, content);
    run_.blocks.push_back({pixels_.front(), run_.file->size(),
                           static_cast<std::uint32_t>(block.size()),
                           static_cast<std::uint32_t>(pixels_.size())});
    run_.file->append(block);
    pixels_.clear();
    heights_.clear();
  }

  Run run_;
  std::vector<std::uint64_t> pixels_;
  std::vector<double> heights_;
};

/// A place among the points of a run, or among sorted ones in memory.
class PixelPoints::Cursor {
 public:
  explicit Cursor(const Run& run) : run_(&run) {}
  explicit Cursor(std::vector<PointInPixel> points) : points_(std::move(points)) {}

  /// Goes to the first point whose pixel is not below this one. False if there is none.
  bool seek(std::uint64_t pixel) {
    const bool is_here =
        !points_.empty() && points_.front().pixel < pixel && points_.back().pixel >= pixel;
    if (!is_here && run_ != nullptr) {
      // The block before the first one that begins there may end there.
      const auto found = std::ranges::lower_bound(run_->blocks, pixel, {}, &Block::first_pixel);
      const auto place = static_cast<std::size_t>(found - run_->blocks.begin());
      load(place > 0 ? place - 1 : 0);
    }
    const auto first = std::ranges::lower_bound(points_, pixel, {}, &PointInPixel::pixel);
    at_ = static_cast<std::size_t>(first - points_.begin());
    return at_ < points_.size() || load(next_);
  }

  [[nodiscard]] const PointInPixel& point() const { return points_[at_]; }
  bool advance() { return ++at_ < points_.size() || load(next_); }

 private:
  bool load(std::size_t block) {
    if (run_ == nullptr || block >= run_->blocks.size()) return false;
    at_ = 0;
    if (block + 1 == next_) return true;  // it is here
    next_ = block + 1;
    const auto& [first_pixel, offset, bytes, count] = run_->blocks[block];
    const FileSpot where{run_->file->name(), at_byte(offset)};
    std::vector<std::byte> stored(bytes);
    run_->file->read(offset, stored);
    const std::span<const std::byte> all(stored);
    const BlockHead head = decode_block_head(all.first<kBlockHeadSize>(), where);
    std::vector<std::byte> content;
    decode_block(head, all.subspan(kBlockHeadSize), content, where);
    std::vector<std::uint64_t> pixels;
    std::vector<double> heights;
    ColumnReader reader(content, where);
    reader.read(count, pixels);
    reader.read(count, heights);
    points_.resize(count);
    for (std::size_t i = 0; i < count; ++i) points_[i] = {pixels[i], heights[i]};
    return true;
  }

  const Run* run_ = nullptr;
  std::size_t next_ = 0;  ///< the block after the one that is here
  std::vector<PointInPixel> points_;
  std::size_t at_ = 0;
};

/// Runs as one.
class PixelPoints::Merge {
 public:
  explicit Merge(std::vector<Cursor> cursors) : cursors_(std::move(cursors)) {}

  /// Calls `take` for each point with a pixel from `first` on and below `end`, in order.
  template <typename Take>
  void pass(std::uint64_t first, std::uint64_t end, const Take& take) {
    using Head = std::pair<PointInPixel, std::size_t>;
    std::priority_queue<Head, std::vector<Head>, std::greater<>> heads;
    for (std::size_t c = 0; c < cursors_.size(); ++c) {
      if (cursors_[c].seek(first)) heads.emplace(cursors_[c].point(), c);
    }
    while (!heads.empty() && heads.top().first.pixel < end) {
      const std::size_t c = heads.top().second;
      heads.pop();
      // As long as this cursor has the least one.
      for (bool is_more = true; is_more;) {
        take(cursors_[c].point());
        if (!cursors_[c].advance()) break;
        is_more = cursors_[c].point().pixel < end &&
                  (heads.empty() || cursors_[c].point() <= heads.top().first);
        if (!is_more) heads.emplace(cursors_[c].point(), c);
      }
    }
  }

 private:
  std::vector<Cursor> cursors_;
};

PixelPoints::PixelPoints(std::uint64_t memory, ScratchFolder& scratch)
    : scratch_(scratch), capacity_(points_at_a_time(memory)) {}

PixelPoints::~PixelPoints() = default;

void PixelPoints::add(std::span<const PointInPixel> points) {
  std::unique_lock lock(mutex_);
  while (!points.empty()) {
    const std::size_t some = std::min(points.size(), capacity_ - waiting_.size());
    if (waiting_.empty()) waiting_.reserve(capacity_);
    waiting_.insert(waiting_.end(), points.begin(),
                    points.begin() + static_cast<std::ptrdiff_t>(some));
    points = points.subspan(some);
    if (waiting_.size() < capacity_) continue;
    // Others may fill the next list while this one is sorted, but no third one.
    std::unique_lock runs(runs_mutex_);
    std::vector<PointInPixel> full = std::exchange(waiting_, {});
    lock.unlock();
    add_run(full);
    runs.unlock();
    full = {};
    lock.lock();
  }
}

/// With runs_mutex_ held.
void PixelPoints::add_run(std::vector<PointInPixel>& points) {
  std::ranges::sort(points);
  Writer writer(0, scratch_);
  for (const PointInPixel& point : points) writer.put(point);
  runs_.push_back(writer.finish());
  spilled_ += runs_.back().file->size();
  merge_runs();
}

void PixelPoints::merge_runs() {
  for (;;) {
    const std::uint32_t level = runs_.back().level;
    const auto first = std::ranges::find(runs_, level, &Run::level);
    if (runs_.end() - first < static_cast<std::ptrdiff_t>(kMostRuns)) return;
    std::vector<Cursor> cursors;
    for (auto run = first; run != runs_.end(); ++run) cursors.emplace_back(*run);
    Writer writer(level + 1, scratch_);
    Merge(std::move(cursors))
        .pass(0, std::numeric_limits<std::uint64_t>::max(),
              [&](const PointInPixel& point) { writer.put(point); });
    runs_.erase(first, runs_.end());
    runs_.push_back(writer.finish());
    spilled_ += runs_.back().file->size();
  }
}

void PixelPoints::begin_reading() {
  if (merge_) return;
  std::ranges::sort(waiting_);
  std::vector<Cursor> cursors;
  for (const Run& run : runs_) cursors.emplace_back(run);
  cursors.emplace_back(std::exchange(waiting_, {}));
  merge_ = std::make_unique<Merge>(std::move(cursors));
}

void PixelPoints::read(std::uint64_t tile, const std::function<void(const PointInPixel&)>& take) {
  begin_reading();
  merge_->pass(tile * kTilePixels, (tile + 1) * kTilePixels, take);
}

void PixelPoints::read_all(const std::function<void(const PointInPixel&)>& take) {
  begin_reading();
  merge_->pass(0, std::numeric_limits<std::uint64_t>::max(), take);
}

std::uint64_t PixelPoints::spilled_bytes() const {
  const std::lock_guard lock(runs_mutex_);
  return spilled_;
}

void PixelPoints::save(StateWriter& state) {
  state.section("points in pixels");
  // As they are: a file that is made now would not be known to who goes on.
  std::uint64_t count = runs_.size();
  state(waiting_, spilled_, count);
  for (Run& run : runs_) {
    state(run.level, run.blocks);
    state.file(run.file);
  }
}

void PixelPoints::restore(StateReader& state) {
  state.section("points in pixels");
  std::uint64_t count = 0;
  state(waiting_, spilled_, count);
  runs_.resize(count);
  for (Run& run : runs_) {
    state(run.level, run.blocks);
    state.file(run.file);
  }
}

}  // namespace spillway::stream
