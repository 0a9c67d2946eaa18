#pragma once

#include <mutex>

#include "src/library/mesh_view.h"
#include "src/library/start_tree.h"

namespace spillway::library {

/// The tree of a mesh in which searches begin, made when it is first asked for: who asks nothing
/// does not wait for it.
template <int D, class Index>
class SearchStarts {
 public:
  /// The tree of this mesh, which has to be the same each time. May be called by many threads at
  /// once; the first one makes the tree, with at most `threads` threads, and the others wait. Not
  /// to be called by the threads of a with_threads(): one that waits would not lend a hand.
  const StartTree<D, Index>& of(const MeshView<D, Index>& mesh, unsigned threads) const;

 private:
  mutable std::once_flag made_;
  mutable StartTree<D, Index> tree_;  // written once, as made_ says
};

}  // namespace spillway::library
