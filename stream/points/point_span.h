#pragma once

#include <atomic>
#include <cstdint>
#include <mutex>
#include <vector>

#include "src/geometry/point.h"
#include "stream/points/points_view.h"

namespace spillway::stream {

/// Whether points that come block by block span D dimensions: exact, and over as soon as D + 1 of
/// them are found that do. Until then each point costs a predicate.
template <int D>
class PointSpan {
 public:
  /// By any number of threads at a time.
  void add(const PointsView& points);

  /// Whether they span D dimensions.
  [[nodiscard]] bool full() const { return full_; }

  /// What is known of points that do not: affinely independent ones, which span all others, and
  /// whether any other is different from them. While no thread adds any.
  struct Facts {
    std::vector<Point<D>> points;
    bool others = false;
  };
  [[nodiscard]] const Facts& facts() const { return facts_; }

  template <typename State>
  void state(State& state) {
    state(facts_.points, facts_.others, full_);
  }

  /// What is known of all points, given what is known of this part and of another.
  void add(const Facts& other);

 private:
  std::mutex mutex_;  ///< guards the next one
  Facts facts_;
  std::atomic<bool> full_ = false;
};

/// Throws Failure unless the `points` points span D dimensions; it says what they are instead.
template <int D>
void refuse_flat_points(const PointSpan<D>& span, std::uint64_t points);

}  // namespace spillway::stream
