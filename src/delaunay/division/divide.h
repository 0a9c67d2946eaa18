#pragma once

#include <spillway/choices.h>

#include <cstddef>
#include <cstdint>
#include <span>
#include <stop_token>
#include <vector>

#include "src/geometry/box.h"
#include "src/geometry/point.h"

namespace spillway::runtime {
struct Task;
}

namespace spillway::delaunay {

struct DivideOptions {
  std::size_t leaf_points = 0;  ///< parts of at most this many points are not divided further
  /// Which axis is cut. The last three are "dynamic", "cyclic" and "constant" of Funke, Sanders
  /// 2017, section 3.
  Division scheme = Division::kLeastBorder;
  unsigned children = 2;   ///< parts made of one part at a time, at least 2
  std::stop_token stop{};  ///< looked at before each part is divided
  /// Whether parts need not be of equal size, so that leaves are few and nearly full.
  bool fill_leaves = false;
  /// With Division::kLeastBorder, the smallest part of which a sample is triangulated
  /// (CutJudgement) if it is hollow.
  std::size_t smallest_judged = 32'768;
  /// A part of at most so many points is a leaf, whatever its size, if the sample says that no cut
  /// pays.
  std::size_t largest_undivided = 0;
};

/// A node of the k-d tree over an array of points.
template <int D>
struct Part {
  VertexId begin = 0;  ///< its points are [begin, end) of the array
  VertexId end = 0;
  Box<D> box;                  ///< tight around them
  std::uint32_t list = 0;      ///< of its simplices; children come before parents
  std::vector<Part> children;  ///< none for a leaf

  [[nodiscard]] std::size_t size() const { return end - begin; }
  [[nodiscard]] bool leaf() const { return children.empty(); }
};

/// Divides the points into a k-d tree and puts them, with their input indices, into its order,
/// those of a leaf into the order of a Hilbert curve. Cuts compare coordinates with a value taken
/// from a sample, so equal points always stay together; a part is a leaf when it has at most
/// leaf_points points or when all its points are equal. Where the sample has no extent on the
/// scheme's axis the longest one is cut. The result doesn't depend on the number of threads. If
/// `task` is set, it receives the tree of divisions with their durations. Throws Interrupted if a
/// stop was requested in time.
template <int D>
Part<D> divide(std::span<Point<D>> points, std::span<VertexId> input_index,
               const DivideOptions& options, Task* task = nullptr);

}  // namespace spillway::delaunay
