#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "formats/points/copc/node_key.h"

namespace spillway::formats {

/// The pages of a hierarchy, the root page first.
struct HierarchyPages {
  std::vector<std::byte> bytes;
  std::size_t root_size = 0;  ///< bytes of the root page
};

/// The pages of these nodes, of which those above all are among them, if they are to lie in a file
/// from byte `begin` on. Up to `most_together` nodes are one page; more are pages of four levels.
HierarchyPages hierarchy_pages(std::vector<HierarchyEntry> nodes, std::uint64_t begin,
                               std::size_t most_together = 4096);

}  // namespace spillway::formats
