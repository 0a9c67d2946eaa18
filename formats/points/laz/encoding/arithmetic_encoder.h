#pragma once
// The entropy encoder: docs/formats-laz.md.

#include <cstddef>
#include <cstdint>
#include <vector>

#include "formats/points/laz/coding/models.h"
#include "formats/points/laz/coding/select.h"

namespace spillway::formats::laz {

/// Writes bits and symbols as one stream, which ArithmeticDecoder reads. A carry may change bytes
/// that are already written, so a stream stays in memory until it ends.
class ArithmeticEncoder {
 public:
  /// The next symbol, by its model, which learns it.
  template <unsigned Most>
  [[gnu::always_inline]] void symbol(unsigned symbol, SymbolModel<Most>& model) {
    const std::uint32_t unit = length_ >> 15U;
    const std::uint32_t low = unit * model.below(symbol);
    const std::uint32_t high =
        select_if_below(symbol + 1, model.symbols(), unit * model.below(symbol + 1), length_);
    narrow(low, high - low);
    model.count(symbol);
  }

  [[gnu::always_inline]] void bit(bool bit, BitModel& model) {
    const std::uint32_t middle = model.zero() * (length_ >> 13U);
    narrow(bit ? middle : 0, bit ? length_ - middle : middle);
    model.count(bit);
  }

  /// A number of 1 to 32 bits that has no model, and no bits above these.
  [[gnu::always_inline]] void raw(std::uint32_t number, unsigned bits) {
    if (bits > kMostRaw) [[unlikely]] {
      few_raw(number & 0xFFFFU, 16);
      few_raw(number >> 16U, bits - 16);
      return;
    }
    few_raw(number, bits);
  }

  void raw64(std::uint64_t number) {
    raw(static_cast<std::uint32_t>(number), 32);
    raw(static_cast<std::uint32_t>(number >> 32U), 32);
  }

  /// Ends the stream, so that a decoder takes its last byte with the last symbol, and appends it.
  /// A new stream begins.
  void finish(std::vector<std::byte>& out);

  /// Begins a new stream; what was written of this one is dropped.
  void reset();

 private:
  static constexpr std::uint32_t kLeastLength = 1U << 24U;
  static constexpr unsigned kMostRaw = 19;

  [[gnu::always_inline]] void few_raw(std::uint32_t number, unsigned bits) {
    const std::uint32_t unit = length_ >> bits;
    narrow(number * unit, unit);
  }

  /// Goes on with a part of the interval.
  [[gnu::always_inline]] void narrow(std::uint32_t low, std::uint32_t length) {
    base_ += low;
    if (base_ < low) [[unlikely]] {
      carry();
    }
    length_ = length;
    while (length_ < kLeastLength) {
      if (size_ == bytes_.size()) [[unlikely]] {
        grow();
      }
      bytes_[size_++] = static_cast<std::byte>(base_ >> 24U);
      base_ <<= 8U;
      length_ <<= 8U;
    }
  }

  void carry();
  void grow();

  std::uint32_t base_ = 0;
  std::uint32_t length_ = 0xFFFFFFFF;
  std::size_t size_ = 0;  // of the stream so far
  std::vector<std::byte> bytes_;
};

}  // namespace spillway::formats::laz
