#pragma once
// What is measured for each dimension of how tiles are triangulated: it decides when the run asks
// for memory and in what way it works, never what is written.

#include <cstddef>
#include <cstdint>
#include <limits>

#include "src/rooms.h"

namespace spillway::stream {

/// The general ones, for D > 3, where a point has about 32, 190 or 1,300 simplices.
template <int D>
struct TileTuning {
  static constexpr std::size_t kSmallestJudged = std::numeric_limits<std::size_t>::max();
  static constexpr std::uint64_t kLeafBytes = D == 4 ? 5'000 : D == 5 ? 36'000 : 300'000;
  static constexpr std::uint64_t kMergeBytes = kLeafBytes * 6 / 5;
  static constexpr std::uint64_t kAllBorderMergeBytes = kLeafBytes * 8 / 5;
};

template <>
struct TileTuning<2> {
  /// Of parts of fewer points that are divided, the longest axis is cut unseen: what a sample tells
  /// would cost more than it saves.
  static constexpr std::size_t kSmallestJudged = 4'096;
  /// Bytes for each point of a leaf while it is triangulated, where it makes as many simplices as
  /// usual: the records of the kernel, and then what is made of them.
  static constexpr std::uint64_t kLeafBytes = 160;
  /// Bytes for each point of a border while it is triangulated; and where the border is all there
  /// is, as for points of a sphere: then the parts of that triangulation have borders as large.
  static constexpr std::uint64_t kMergeBytes = 320;
  static constexpr std::uint64_t kAllBorderMergeBytes = 360;
};

template <>
struct TileTuning<3> {
  static constexpr std::size_t kSmallestJudged = 8'192;
  static constexpr std::uint64_t kLeafBytes = 540;
  static constexpr std::uint64_t kMergeBytes = 900;
  static constexpr std::uint64_t kAllBorderMergeBytes = 1400;
};

}  // namespace spillway::stream
