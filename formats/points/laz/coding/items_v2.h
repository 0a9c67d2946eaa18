#pragma once
// Pointwise items, version 2: docs/formats-laz.md. Instantiated for both ways to keep values.

#include <array>
#include <cstddef>
#include <cstdint>

#include "formats/points/laz/coding/integer_decoder.h"
#include "formats/points/laz/coding/pointwise_item.h"
#include "formats/points/laz/coding/streaming_median.h"

namespace spillway::formats::laz {

/// The attributes come first, so that returns of a kind predict each other's coordinates.
template <Keep kKeep>
class Point10V2 final : public Point10Item {
 public:
  void reset(const std::byte* first) override;
  void decode(ArithmeticDecoder& stream, std::byte* part) override;

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
  std::array<std::uint16_t, 16> last_intensity_{};
  std::array<std::int32_t, 8> last_z_{};
};

template <Keep kKeep>
class Rgb12V2 final : public PointwiseItem {
 public:
  void reset(const std::byte* first) override;
  void decode(ArithmeticDecoder& stream, std::byte* part) override;

 private:
  SymbolModels<128> used_{1};
  SymbolModels<256> differences_{6};
};

template <Keep kKeep>
class ByteV2 final : public PointwiseItem {
 public:
  explicit ByteV2(std::size_t bytes) : bytes_(bytes), differences_(bytes) {}
  void reset(const std::byte* /*first*/) override { differences_.reset(); }
  void decode(ArithmeticDecoder& stream, std::byte* part) override;

 private:
  std::size_t bytes_;
  SymbolModels<256> differences_;
};

}  // namespace spillway::formats::laz
