#pragma once
// GPS times, item version 2 and layered: docs/formats-laz.md.

#include <array>
#include <cstddef>
#include <cstdint>

#include "formats/points/laz/coding/integer_decoder.h"
#include "formats/points/laz/coding/pointwise_item.h"

namespace spillway::formats::laz {

/// Decodes GPS times as bit patterns: four sequences, as pulses of several scanners alternate, each
/// running with a step of its own. `kLayered`: there is no symbol for a time that does not change.
template <bool kLayered, Keep kKeep>
class GpsTimeDecoder {
 public:
  void reset(std::uint64_t first);
  void decode(ArithmeticDecoder& stream);
  /// The time decoded last, if times are kept.
  [[nodiscard]] std::uint64_t time() const { return sequences_[current_].time; }

 private:
  struct Sequence {
    std::uint64_t time = 0;
    std::int32_t difference = 0;
    unsigned extreme = 0;

    void add(std::uint32_t step) {
      if constexpr (kKeep == Keep::kWhole) time = sum64(time, step);
    }
  };

  void begin_sequence(ArithmeticDecoder& stream);

  static constexpr unsigned kLeftOut = kLayered ? 1 : 0;  // symbols

  SymbolModels<516 - kLeftOut> multiple_{1};
  SymbolModels<6 - kLeftOut> zero_{1};
  IntegerDecoder<32> difference_{9};
  std::array<Sequence, 4> sequences_{};
  unsigned current_ = 0;
  unsigned newest_ = 0;
};

/// Instantiated for both ways to keep values.
template <Keep kKeep>
class GpsTime11V2 final : public PointwiseItem {
 public:
  void reset(const std::byte* first) override { times_.reset(load<std::uint64_t>(first)); }
  void decode(ArithmeticDecoder& stream, std::byte* part) override;

 private:
  GpsTimeDecoder<false, kKeep> times_;
};

}  // namespace spillway::formats::laz
