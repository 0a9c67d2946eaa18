#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "stream/tiles/storage/tile.h"
#include "stream/tiles/tile_node.h"
#include "stream/triangulate/border.h"
#include "stream/triangulate/surroundings.h"

namespace spillway::stream {

/// Keeps the trees that a node and its `Outside` point to.
template <int D>
struct KeptTrees {
  std::shared_ptr<const TileNode<D>> root;
  std::vector<std::shared_ptr<TileNode<D>>> outside;
};

/// What an engine knows of a node, which is a tile or a merge of tiles. Its number is its slot of
/// the stream.
template <int D>
struct EngineNode {
  const TileNode<D>* tree = nullptr;
  Outside<D> outside;
  std::shared_ptr<const KeptTrees<D>> kept;  ///< that the two point to, or none
  bool outside_shrank = false;               ///< as in MergeInput
  std::uint32_t level = 0;                   ///< merges below, at most
  StoredTile stored{};                       ///< of a tile that is being worked off
  Border<D> border{};                        ///< once it is done
};

}  // namespace spillway::stream
