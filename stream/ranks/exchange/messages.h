#pragma once
// What ranks tell each other, as bytes.

#include <cstddef>
#include <span>
#include <vector>

#include "src/distributed/packing.h"
#include "stream/source/source_facts.h"
#include "stream/tiles/tile_tree.h"
#include "stream/triangulate/border.h"

namespace spillway::detail {

void pack(distributed::Packer& message, const SourceFacts& facts);
SourceFacts unpack_source_facts(distributed::Unpacker& message);

/// Boxes and numbers of points of a tree of tiles; nothing of how they are stored.
template <int D>
void pack(distributed::Packer& message, const TileNode<D>& tree);
template <int D>
TileNode<D> unpack_tile_node(distributed::Unpacker& message);

template <int D>
void pack(distributed::Packer& message, const Border<D>& border, bool with_index);
template <int D>
Border<D> unpack_border(distributed::Unpacker& message, bool with_index);

}  // namespace spillway::detail
