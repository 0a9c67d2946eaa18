#pragma once

#include <array>
#include <cstdint>

#include "tests/formats/points/laz/laz_encoder/integer_compressor.h"

namespace spillway::detail::testing {

/// GPS times as bit patterns: up to four interleaved sequences, each running with a step of its
/// own. Item version 2, and the layer of POINT14.
class GpsSequences {
 public:
  /// `layered`: there is no symbol for a time that does not change.
  GpsSequences(std::uint64_t first, bool layered);
  void encode(ArithmeticEncoder& encoder, std::uint64_t time);

 private:
  struct Sequence {
    std::uint64_t time = 0;
    std::int32_t step = 0;
    int extremes = 0;
  };

  /// Encodes a time that the current sequence reaches by a 32-bit step.
  void encode_step(ArithmeticEncoder& encoder, std::int32_t step);
  void encode_multiple(ArithmeticEncoder& encoder, std::int32_t step);
  void note_extreme(std::int32_t step);
  void begin_sequence(ArithmeticEncoder& encoder, std::uint64_t time);
  /// Encodes one of the symbols by the numbers of the pointwise item.
  void choose(ArithmeticEncoder& encoder, unsigned without_step, unsigned with_step);
  [[nodiscard]] bool reaches(std::size_t sequence, std::uint64_t time) const;

  bool layered_;
  std::array<Sequence, 4> sequences_;
  std::size_t current_ = 0;
  std::size_t newest_ = 0;
  SymbolModel with_step_;
  SymbolModel without_step_;
  IntegerCompressor values_{32, 9};
};

}  // namespace spillway::detail::testing
