#pragma once
// What ranks tell each other, as bytes.

#include <cstddef>
#include <span>
#include <vector>

#include "src/runtime/packing.h"
#include "stream/source/source_facts.h"
#include "stream/tiles/tile_tree.h"
#include "stream/triangulate/border.h"

namespace spillway::ranks {

void pack(Packer& message, const SourceFacts& facts);
SourceFacts unpack_source_facts(Unpacker& message);

/// Boxes and numbers of points of a tree of tiles; nothing of how they are stored.
template <int D>
void pack(Packer& message, const TileNode<D>& tree);
template <int D>
TileNode<D> unpack_tile_node(Unpacker& message);

template <int D>
void pack(Packer& message, const Border<D>& border, bool with_index);
template <int D>
Border<D> unpack_border(Unpacker& message, bool with_index);

}  // namespace spillway::ranks
