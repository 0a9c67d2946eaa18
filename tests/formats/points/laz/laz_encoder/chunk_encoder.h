#pragma once

#include <span>
#include <string>
#include <vector>

#include "formats/points/laz/chunk_decoder.h"

namespace spillway::test {

struct LazChunkOptions {
  /// Layered: writes also the layers in which nothing changes.
  bool all_layers = false;
  /// Layered: leaves out the z layer too if all points have the same z.
  bool empty_z_layer = false;
};

/// The bytes of a chunk of these records, which have the items one after the other: pointwise or
/// layered as the items are.
std::string encode_laz_chunk(const std::vector<LazItem>& items,
                             std::span<const std::string> records,
                             const LazChunkOptions& options = {});

}  // namespace spillway::test
