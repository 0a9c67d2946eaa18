#include "stream/source/thinning/point_runs.h"

#include <algorithm>

namespace spillway::stream {
namespace {

/// Points of a run that are read at a time.
constexpr std::size_t kPiece = 1024;
constexpr std::size_t kFewestAtATime = 2;
constexpr std::size_t kMostAtATime = 4096;

constexpr const char* kLabel = "runs";

}  // namespace

PointRuns::PointRuns(std::uint64_t memory, ScratchFolder& scratch)
    : scratch_(scratch),
      most_at_a_time_(std::clamp<std::size_t>(memory / (kPiece * sizeof(RunPoint)), kFewestAtATime,
                                              kMostAtATime)) {}

void PointRuns::begin_run() {
  std::shared_ptr<ScratchFile> file = runs_.empty() ? scratch_.create(kLabel) : runs_.back().file;
  const std::uint64_t begin = file->size();
  runs_.push_back({std::move(file), begin, begin});
}

void PointRuns::append(std::span<const RunPoint> sorted) {
  Run& run = runs_.back();
  run.file->append(std::as_bytes(sorted));
  run.end = run.file->size();
}

/// Makes one run of as many as can be merged at a time, and so on, once through all runs. What they
/// were read from leaves the disk.
void PointRuns::merge_some() {
  std::vector<Run> merged;
  const std::shared_ptr<ScratchFile> file = scratch_.create(kLabel);
  std::vector<RunPoint> points;
  for (std::size_t begin = 0; begin < runs_.size(); begin += most_at_a_time_) {
    const std::uint64_t begin_in_file = file->size();
    const std::size_t count = std::min(most_at_a_time_, runs_.size() - begin);
    Merge merge(std::span<const Run>(runs_).subspan(begin, count));
    while (merge.next(points, kPiece)) file->append(std::as_bytes(std::span(points)));
    merged.push_back({file, begin_in_file, file->size()});
  }
  runs_ = std::move(merged);
}

bool PointRuns::next(std::vector<RunPoint>& points, std::size_t most) {
  if (!merge_) {
    while (runs_.size() > most_at_a_time_) merge_some();
    merge_.emplace(runs_);
    runs_.clear();
  }
  return merge_->next(points, most);
}

PointRuns::Merge::Merge(std::span<const Run> runs) {
  for (const Run& run : runs) {
    cursors_.push_back({run, {}, 0});
    enter(cursors_.size() - 1);
  }
}

/// Puts the next point of a cursor among the heads, if it has any.
void PointRuns::Merge::enter(std::size_t number) {
  Cursor& cursor = cursors_[number];
  if (cursor.place == cursor.piece.size()) {
    Run& rest = cursor.rest;
    const auto count = std::min<std::uint64_t>(kPiece, (rest.end - rest.begin) / sizeof(RunPoint));
    if (count == 0) {
      cursor = {};
      return;
    }
    cursor.piece.resize(count);
    const auto bytes = std::as_writable_bytes(std::span(cursor.piece));
    rest.file->read(rest.begin, bytes);
    rest.begin += bytes.size();
    cursor.place = 0;
  }
  heads_.emplace(cursor.piece[cursor.place].order, number);
}

bool PointRuns::Merge::next(std::vector<RunPoint>& points, std::size_t most) {
  points.clear();
  while (points.size() < most && !heads_.empty()) {
    const std::size_t number = heads_.top().second;
    heads_.pop();
    Cursor& cursor = cursors_[number];
    points.push_back(cursor.piece[cursor.place++]);
    enter(number);
  }
  return !points.empty();
}

}  // namespace spillway::stream
