#pragma once

#include <cstdint>
#include <mutex>
#include <span>
#include <thread>
#include <vector>

#include "stream/triangulate/border.h"

namespace spillway::stream {

/// What borders between tiles have taken so far, and from that what the rest of the run will need.
/// Used by many threads.
template <int D>
class BorderGrowth {
 public:
  /// What a budget refuses a run.
  struct Shortage {
    std::uint64_t limit = 0;
    std::uint64_t used = 0;        ///< bytes
    std::uint64_t refused = 0;     ///< bytes, to the thread that asks
    std::uint64_t loaded = 0;      ///< most points of tiles in memory, which grow with the limit
    std::uint64_t all_points = 0;  ///< of the whole run
    std::uint64_t densest = 0;     ///< simplices for each point of a leaf, at most
    std::size_t record_size = 0;   ///< bytes of a point's attributes
  };

  /// A tile of so many points is done.
  void add_tile(std::uint64_t points, const Border<D>& border);

  /// This thread begins a merge of borders, of so many points below; and it has ended the same,
  /// which has triangulated some points of them.
  void begin_merge(std::uint64_t points, std::span<const Border<D>> children);
  void end_merge(std::uint64_t triangulated, const Border<D>& border);

  /// A limit with which the rest of the points does as what has been done so far; 0 if nothing can
  /// be told. Borders are taken to grow on as they have grown with the points that are done, at
  /// least as the surface of what they surround; all else grows with the limit. If most points have
  /// stayed in borders, or no tile is done yet, all may stay there.
  [[nodiscard]] std::uint64_t enough_for(const Shortage& shortage) const;

 private:
  struct Merge {
    std::thread::id thread;
    std::uint64_t points = 0;
    std::uint64_t bytes = 0;         ///< of the children's borders, which it copies
    std::uint64_t triangulated = 0;  ///< bytes, if it triangulates all of their vertices
  };

  [[nodiscard]] auto merge_of_this_thread() const;
  [[nodiscard]] double growth_exponent() const;

  mutable std::mutex mutex_;  ///< guards all others
  std::uint64_t tiles_ = 0;
  std::uint64_t points_ = 0;      ///< of these tiles
  std::uint64_t tile_bytes_ = 0;  ///< of their borders, each when it was done
  std::uint64_t tile_vertices_ = 0;
  std::uint64_t bytes_ = 0;       ///< of borders of tiles and merges in memory
  std::uint64_t most_bytes_ = 0;  ///< the same at its highest
  std::vector<Merge> under_way_;
  std::uint64_t most_merge_ = 0;         ///< bytes that one merge took
  std::uint64_t most_merge_points_ = 0;  ///< below that
};

}  // namespace spillway::stream
