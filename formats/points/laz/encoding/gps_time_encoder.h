#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "formats/points/laz/encoding/integer_encoder.h"

namespace spillway::formats::laz {

/// Encodes GPS times as bit patterns: up to four interleaved sequences, each running with a step of
/// its own. Item version 2, and the layer of POINT14.
class GpsTimeSequences {
 public:
  /// `layered`: there is no symbol for a time that does not change.
  explicit GpsTimeSequences(bool layered) : layered_(layered) {}

  void reset(std::uint64_t first);
  void encode(ArithmeticEncoder& stream, std::uint64_t time);

 private:
  struct Sequence {
    std::uint64_t time = 0;
    std::int32_t step = 0;
    unsigned extreme = 0;
  };

  /// Encodes a time that the current sequence reaches by a 32-bit step.
  void encode_step(ArithmeticEncoder& stream, std::int32_t step);
  void encode_multiple(ArithmeticEncoder& stream, std::int32_t step);
  void begin_sequence(ArithmeticEncoder& stream, std::uint64_t time);
  /// Encodes one of two symbols, by whether the current sequence has a step; numbers are those of
  /// the pointwise item.
  void choose(ArithmeticEncoder& stream, unsigned without_step, unsigned with_step);
  [[nodiscard]] bool reaches(std::size_t sequence, std::uint64_t time) const;

  bool layered_;
  std::array<Sequence, 4> sequences_{};
  std::size_t current_ = 0;
  std::size_t newest_ = 0;
  SymbolModels<516> with_step_{1};
  SymbolModels<6> without_step_{1};
  IntegerEncoder<32> differences_{9};
};

}  // namespace spillway::formats::laz
