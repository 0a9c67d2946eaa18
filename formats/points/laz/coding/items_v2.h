#pragma once
// Pointwise items, version 2: docs/formats-laz.md.

#include <array>
#include <cstdint>

#include "formats/points/laz/coding/integer_decoder.h"
#include "formats/points/laz/coding/pointwise_item.h"
#include "formats/points/laz/coding/streaming_median.h"

namespace spillway::detail::laz {

/// The attributes come first, so that returns of a kind predict each other's coordinates.
class Point10V2 : public Point10Item {
 public:
  void reset() override;
  void decode(ArithmeticDecoder& stream) override;

 private:
  SymbolModels<64> changed_{1};
  SymbolModels<256> returns_{256};
  SymbolModels<256> classification_{256};
  SymbolModels<256> user_{256};
  SymbolModels<256> angle_{2};
  IntegerDecoder<16> intensity_{4};
  IntegerDecoder<16> source_{1};
  IntegerDecoder<32> dx_{2};
  IntegerDecoder<32> dy_{22};
  IntegerDecoder<32> z_{20};
  std::array<StreamingMedian, 16> dx_median_{};
  std::array<StreamingMedian, 16> dy_median_{};
  std::array<std::int32_t, 8> last_z_{};
};

/// Four sequences of times, as pulses of several scanners alternate.
class GpsTime11V2 : public PointwiseItem {
 public:
  void reset() override;
  void decode(ArithmeticDecoder& stream) override;

 private:
  struct Sequence {
    std::int32_t difference = 0;
    unsigned extreme = 0;
  };

  void begin_sequence(ArithmeticDecoder& stream);

  SymbolModels<516> multiple_{1};
  SymbolModels<6> zero_{1};
  IntegerDecoder<32> difference_{9};
  std::array<Sequence, 4> sequences_{};
  unsigned current_ = 0;
  unsigned newest_ = 0;
};

class Rgb12V2 : public PointwiseItem {
 public:
  void reset() override;
  void decode(ArithmeticDecoder& stream) override;

 private:
  SymbolModels<128> used_{1};
  SymbolModels<256> differences_{6};
};

class ByteV2 : public PointwiseItem {
 public:
  explicit ByteV2(std::size_t bytes) : bytes_(bytes), differences_(bytes) {}
  void reset() override { differences_.reset(); }
  void decode(ArithmeticDecoder& stream) override;

 private:
  std::size_t bytes_;
  SymbolModels<256> differences_;
};

}  // namespace spillway::detail::laz
