#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <variant>
#include <vector>

#include "src/delaunay/border/simplex_index.h"
#include "src/geometry/point.h"

namespace spillway::delaunay {

/// Which simplices of the triangulation of a border the merged triangulation has (Funke, Sanders
/// 2017, Algorithm 1): those that span children or lie in an open one are new; of the others those
/// that their own child has in its border, facing the same way. All others are dropped.
template <int D>
class Acceptance {
 public:
  using Vertices = std::array<VertexId, D + 1>;

  /// Vertices are numbered child by child: `ends` tells for each where its numbers end, `open`
  /// whether it is open. `border` has the simplices of all children's borders and must outlive it.
  /// Uses all threads.
  Acceptance(std::span<const VertexId> ends, std::vector<bool> open,
             std::span<const Vertices> border)
      : ends_(ends.begin(), ends.end() - 1), open_(std::move(open)), index_(border) {}

  /// Whether a simplex spans children or lies in an open one.
  [[nodiscard]] bool is_new(const Vertices& simplex) const {
    std::size_t lowest = ends_.size();
    std::size_t highest = 0;
    for (const VertexId v : simplex) {  // without branches for each vertex
      std::size_t child = 0;
      for (const VertexId end : ends_) child += v >= end ? 1 : 0;
      lowest = std::min(lowest, child);  // of the infinite vertex it is the last one
      highest = std::max(highest, v == kInfiniteVertex ? 0 : child);
    }
    return lowest != highest || open_[lowest];
  }

  /// The questions of one thread: simplices that are not new are looked for a batch at a time.
  /// `Tag` tells the caller later what the simplex was.
  template <typename Tag = std::monostate>
  class Questions {
   public:
    /// The number that fills a batch.
    static constexpr std::size_t kBatch = SimplexIndex<D + 1>::kBatch;

    explicit Questions(const Acceptance& acceptance) : acceptance_(acceptance) {}

    /// Whether the simplex is new. If not, found(simplex, tag, place) is called, now or by
    /// answer(), if it is the border's simplex of that place.
    template <typename Found>
    bool is_new(const Vertices& simplex, const Tag& tag, const Found& found) {
      if (acceptance_.is_new(simplex)) return true;
      simplices_[count_] = simplex;
      tags_[count_++] = tag;
      if (count_ == kBatch) answer(found);
      return false;
    }

    /// Answers what is still open.
    template <typename Found>
    void answer(const Found& found) {
      const auto places = acceptance_.index_.find(std::span(simplices_).first(count_));
      for (std::size_t i = 0; i < count_; ++i) {
        if (places[i] != SimplexIndex<D + 1>::kNotFound) found(simplices_[i], tags_[i], places[i]);
      }
      count_ = 0;
    }

   private:
    const Acceptance& acceptance_;
    std::array<Vertices, kBatch> simplices_;
    std::array<Tag, kBatch> tags_;
    std::size_t count_ = 0;
  };

 private:
  std::vector<VertexId> ends_;  ///< of all children but the last
  std::vector<bool> open_;
  SimplexIndex<D + 1> index_;
};

}  // namespace spillway::delaunay
