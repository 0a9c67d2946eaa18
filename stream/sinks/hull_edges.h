#pragma once

#include <array>
#include <compare>
#include <cstdint>
#include <functional>
#include <unordered_map>
#include <vector>

#include "src/terrain/isolines.h"

namespace spillway::stream {

/// An edge of a single triangle, which lies to its left.
struct HullEdge {
  Corner from;
  Corner to;
};

/// Such an edge by the short numbers of a block.
struct ShortEdge {
  std::uint32_t lesser = 0;
  std::uint32_t greater = 0;
  bool from_lesser = false;
  auto operator<=>(const ShortEdge&) const = default;  // NOLINT(modernize-use-nullptr)
};

/// Of the edges of a block's triangles leaves those of one triangle: most have two in their block,
/// and sorting them takes a fraction of what HullEdges takes.
void remove_paired(std::vector<ShortEdge>& edges);

/// Finds the edges of a mesh that have one triangle only, as triangles come in any order. Keeps
/// those that have one so far, at some 120 bytes each.
class HullEdges {
 public:
  using Sink = std::function<void(const HullEdge&)>;

  /// An edge of one more triangle.
  void add(const HullEdge& edge);

  /// Gives out edges that have one triangle, and no other can come, as `is_final` says of the
  /// numbers of their ends. Does nothing before as many edges have come again as are left.
  void release(const std::function<bool(const std::array<std::uint64_t, 2>&)>& is_final,
               const Sink& sink);
  /// Gives out all that are left.
  void finish(const Sink& sink);

  /// Renames vertices, as LineJoiner does.
  void number_from(std::uint64_t first);

 private:
  using Ends = std::array<std::uint64_t, 2>;  ///< the lesser first
  struct EndsHash {
    std::size_t operator()(const Ends& ends) const;
  };
  std::unordered_map<Ends, HullEdge, EndsHash> open_;
  std::uint64_t added_since_release_ = 0;
};

}  // namespace spillway::stream
