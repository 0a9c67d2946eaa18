#pragma once
// What is measured for each dimension: sizes at which one way becomes better than another. They
// decide how long a triangulation takes, never what it is. docs/performance-history.md has how the
// first two were found.

#include <cstddef>

#include "src/rooms.h"

namespace spillway::delaunay {

/// All sizes are numbers of points if nothing else is said. The general ones, for D > 3: a point
/// has about 32, 190 or 1,300 simplices there. From five dimensions on nearly all of a part is its
/// border, so that to divide it does not pay.
template <int D>
struct Tuning {
  /// Smaller base cases lose more to merging, larger ones more to memory.
  static constexpr std::size_t kGoodBaseCase = std::size_t{1} << (D == 4 ? 18 : 20);
  /// Points that are not enough for two base cases of this size stay together.
  static constexpr std::size_t kSmallestBaseCase = D == 4 ? 65'536 : kGoodBaseCase;
  /// The same as the good size for a border's points, which it pays less to divide.
  static constexpr std::size_t kGoodBorderBaseCase = kGoodBaseCase;
  /// Of smaller borders the longest axis is cut unseen.
  static constexpr std::size_t kSmallestJudgedBorder = kGoodBaseCase;
  /// Points of a sample that tell which of two cuts is the better one by far.
  static constexpr std::size_t kJudgedSample = 1'024;
  /// Bytes that a point takes in the largest array of a base case, or more.
  static constexpr std::size_t kBaseCaseBytes = D == 4 ? 4'000 : D == 5 ? 25'000 : 200'000;
  /// Steps of a search that it is worth to know that a region holds no point: its simplex is not
  /// merged, and of those behind it none is asked about.
  static constexpr std::size_t kStepsOfNo = 32'768;
};

template <>
struct Tuning<2> {
  static constexpr std::size_t kGoodBaseCase = 131'072;
  static constexpr std::size_t kSmallestBaseCase = 32'768;
  static constexpr std::size_t kGoodBorderBaseCase = 32'768;
  static constexpr std::size_t kSmallestJudgedBorder = 4'096;
  static constexpr std::size_t kJudgedSample = 512;
  static constexpr std::size_t kBaseCaseBytes = 200;
  static constexpr std::size_t kStepsOfNo = 8'192;
};

template <>
struct Tuning<3> {
  static constexpr std::size_t kGoodBaseCase = 524'288;
  static constexpr std::size_t kSmallestBaseCase = 65'536;
  static constexpr std::size_t kGoodBorderBaseCase = 262'144;
  static constexpr std::size_t kSmallestJudgedBorder = 8'192;
  static constexpr std::size_t kJudgedSample = 1'024;
  static constexpr std::size_t kBaseCaseBytes = 800;
  static constexpr std::size_t kStepsOfNo = 32'768;
};

}  // namespace spillway::delaunay
