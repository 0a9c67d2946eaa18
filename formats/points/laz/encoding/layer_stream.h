#pragma once

#include <cstddef>
#include <vector>

#include "formats/points/laz/encoding/arithmetic_encoder.h"

namespace spillway::formats::laz {

/// One layer of a chunk.
struct LayerStream {
  ArithmeticEncoder stream;
  bool changes = false;  ///< whether a point differs from the first one in what the layer holds

  void reset() {
    stream.reset();
    changes = false;
  }

  /// Appends the layer's bytes: none if nothing changes, unless `always`.
  void finish(std::vector<std::byte>& out, bool always) {
    if (changes || always) stream.finish(out);
  }
};

}  // namespace spillway::formats::laz
