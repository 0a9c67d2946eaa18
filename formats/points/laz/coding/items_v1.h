#pragma once
// Pointwise items, version 1: docs/formats-laz.md. Instantiated for both ways to keep values.

#include <array>
#include <cstddef>
#include <cstdint>

#include "formats/points/laz/coding/integer_decoder.h"
#include "formats/points/laz/coding/pointwise_item.h"

namespace spillway::formats::laz {

/// Differences of x and y are predicted by the median of the last three.
template <Keep kKeep>
class Point10V1 final : public Point10Item {
 public:
  void reset(const std::byte* first) override;
  void decode(ArithmeticDecoder& stream, std::byte* part) override;

 private:
  using LastThree = std::array<std::int32_t, 3>;

  SymbolModels<64> changed_{1};
  SymbolModels<256> returns_{256};
  SymbolModels<256> classification_{256};
  SymbolModels<256> user_{256};
  IntegerDecoder<32> dx_{1};
  IntegerDecoder<32> dy_{20};
  IntegerDecoder<32> z_{20};
  IntegerDecoder<16> intensity_{1};
  IntegerDecoder<8> angle_{2};
  IntegerDecoder<16> source_{1};
  LastThree last_dx_{};
  LastThree last_dy_{};
  unsigned oldest_ = 0;  // of the last three
};

template <Keep kKeep>
class GpsTime11V1 final : public PointwiseItem {
 public:
  void reset(const std::byte* first) override;
  void decode(ArithmeticDecoder& stream, std::byte* part) override;

 private:
  SymbolModels<512> multiple_{1};
  SymbolModels<3> zero_{1};
  IntegerDecoder<32> difference_{6};
  std::uint64_t time_ = 0;
  std::int32_t last_difference_ = 0;
  unsigned extreme_ = 0;
};

template <Keep kKeep>
class Rgb12V1 final : public PointwiseItem {
 public:
  void reset(const std::byte* first) override;
  void decode(ArithmeticDecoder& stream, std::byte* part) override;

 private:
  SymbolModels<64> used_{1};
  IntegerDecoder<8> bytes_{6};
};

/// The only version of this item.
template <Keep kKeep>
class WavePacket13 final : public PointwiseItem {
 public:
  void reset(const std::byte* first) override;
  void decode(ArithmeticDecoder& stream, std::byte* part) override;

 private:
  SymbolModels<256> index_{1};
  SymbolModels<4> offset_kind_{4};
  IntegerDecoder<32> offset_{1};
  IntegerDecoder<32> size_{1};
  IntegerDecoder<32> return_point_{1};
  IntegerDecoder<32> direction_{3};
  std::uint32_t last_step_ = 0;
  unsigned last_kind_ = 0;
};

template <Keep kKeep>
class ByteV1 final : public PointwiseItem {
 public:
  explicit ByteV1(std::size_t bytes) : bytes_(bytes), decoder_(bytes) {}
  void reset(const std::byte* /*first*/) override { decoder_.reset(); }
  void decode(ArithmeticDecoder& stream, std::byte* part) override;

 private:
  std::size_t bytes_;
  IntegerDecoder<8> decoder_;
};

}  // namespace spillway::formats::laz
