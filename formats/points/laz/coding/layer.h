#pragma once

#include <cstddef>
#include <span>

#include "formats/points/laz/coding/arithmetic_decoder.h"
#include "src/error.h"

namespace spillway::formats::laz {

/// A layer of a chunk: a stream of its own.
struct Layer {
  bool present = false;  ///< else it is empty, and its values are always those of the first point
  ArithmeticDecoder stream;

  /// Begins a chunk with the first `size` of `layers`, and returns the others.
  std::span<const std::byte> begin(std::span<const std::byte> layers, std::size_t size) {
    present = size > 0;
    stream = present ? ArithmeticDecoder(layers.first(size)) : ArithmeticDecoder();
    return layers.subspan(size);
  }

  /// Checks that it has been read to its end.
  void end() const {
    if (!stream.rest().empty()) throw Failure("a compressed layer is longer than its points");
  }
};

}  // namespace spillway::formats::laz
