#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <span>
#include <unordered_map>
#include <vector>

#include "formats/disk/scratch_folder.h"
#include "src/terrain/isolines.h"
#include "src/terrain/line_shape.h"

namespace spillway::stream {

struct CrossingHash {
  std::size_t operator()(const Crossing& crossing) const;
};

/// Joins segments to whole lines. Segments come in any order; each runs with higher ground to its
/// left, so lines only ever join end to beginning. A line is given out when it closes, or when both
/// its ends lie where nothing more can come. Points of lines that are still open go to the disk
/// when they outgrow their memory.
class LineJoiner {
 public:
  /// Receives a whole line, without repeated points. One that ends with the point that it begins
  /// with is closed, and has of all beginnings the one whose sequence of points is the least in
  /// lexicographic order: so it begins at its least point.
  using Sink = std::function<void(std::span<const Point<2>> points, std::int64_t level)>;

  /// `memory`: bytes for points of open lines. `scratch` must outlive it. With a tolerance lines
  /// are given out in another shape (terrain/line_shape): a closed one begins at the crossing from
  /// which the sequence of its portals is the least, before it gets this shape.
  LineJoiner(Sink sink, std::uint64_t memory, ScratchFolder& scratch, LineTolerance tolerance = {});

  /// Throws Failure if the segment's triangle does not fit to those before it.
  void add(const IsoSegment& segment);

  /// A part of a line that may still grow at both ends.
  struct OpenLine {
    Crossing begin;
    Crossing end;
    std::vector<Point<2>> points;  ///< with a tolerance three each: a portal's
  };
  /// What another joiner has joined. Throws Failure likewise.
  void add(OpenLine&& part);
  /// Hands over all that is open, for another joiner.
  void hand_over(const std::function<void(const OpenLine&)>& take);
  /// Renames vertices: all that came so far were numbered from 0 on, and `first` is the number of
  /// the first.
  void number_from(std::uint64_t first);

  /// Gives out lines that cannot grow any more: those whose both ends lie on edges of which
  /// `is_final` says that no triangle will come to them. Worth a call now and then: it costs as
  /// much as there are open lines, and does nothing before as many segments have come again.
  void release(const std::function<bool(const Crossing&)>& is_final);

  /// Gives out all that is left.
  void finish();

  [[nodiscard]] std::uint64_t lines() const { return lines_; }
  [[nodiscard]] std::uint64_t spilled_bytes() const { return file_ ? file_->size() : 0; }

 private:
  /// Consecutive points of a line, in memory or on the disk.
  struct Stretch {
    std::vector<Point<2>> points;
    std::uint64_t offset = 0;  ///< in the file
    std::uint64_t stored = 0;  ///< points there, if not in memory
  };
  struct Line {
    Crossing begin;
    Crossing end;
    std::vector<Point<2>> front;  ///< the first points, from the last to the first
    std::deque<Stretch> middle;
    std::vector<Point<2>> back;  ///< the last points
  };
  using Number = std::uint32_t;

  using OpenEnds = std::unordered_map<Crossing, Number, CrossingHash>;

  Number new_line();
  void begin_line(const IsoSegment& segment);
  void append_back(Line& line, const Portal& portal);
  void append_front(Line& line, const Portal& portal);
  static void enter(OpenEnds& ends, const Crossing& crossing, Number number);
  void join(Line& first, Line&& second);
  static void gather_front(Line& line);
  void count_out(const Line& line);
  void give_out(Line&& line);
  void forget(Number number);
  void spill();
  void store(Stretch& stretch);
  [[nodiscard]] std::vector<Point<2>> points_of(Line&& line);
  [[nodiscard]] std::vector<Point<2>> shaped(std::span<const Point<2>> points) const;

  Sink sink_;
  std::uint64_t most_points_;
  ScratchFolder& scratch_;
  const LineTolerance tolerance_;
  std::unique_ptr<ScratchFile> file_;
  std::vector<Line> open_;
  std::vector<Number> free_;
  OpenEnds begins_;  ///< lines by where they begin
  OpenEnds ends_;    ///< and by where they end
  std::uint64_t points_in_memory_ = 0;
  std::uint64_t segments_since_release_ = 0;
  std::uint64_t lines_ = 0;
};

}  // namespace spillway::stream
