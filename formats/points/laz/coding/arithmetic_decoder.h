#pragma once
// The entropy decoder: docs/formats-laz.md.

#include <cstddef>
#include <cstdint>
#include <span>

#include "formats/points/laz/coding/models.h"
#include "formats/points/laz/coding/select.h"

namespace spillway::formats {
class LazBytes;
}

namespace spillway::formats::laz {

/// Decodes bits and symbols of one stream. The state is five words that are cheap to copy: loops
/// work on a local copy, which the compiler keeps in registers; that is why nothing here lets the
/// object's address out. Bytes come from a span, then from `source` if there is one, which is asked
/// only when a byte is needed. A byte beyond the end is an Failure.
class ArithmeticDecoder {
 public:
  ArithmeticDecoder() = default;
  /// Reads the four bytes that every stream begins with.
  explicit ArithmeticDecoder(std::span<const std::byte> bytes, LazBytes* source = nullptr);

  /// The symbol that comes next, by its model, which learns it.
  template <unsigned Most>
  [[gnu::always_inline]] unsigned symbol(SymbolModel<Most>& model) {
    const std::uint32_t whole = length_;
    const std::uint32_t unit = length_ >> 15U;
    const SymbolFound found = model.find(value_ / unit);
    const std::uint32_t low = unit * found.low;
    const std::uint32_t high =
        select_if_below(found.symbol + 1, model.symbols(), unit * found.high, whole);
    value_ -= low;
    length_ = high - low;
    renormalise();
    model.count(found.symbol);
    return found.symbol;
  }

  [[gnu::always_inline]] bool bit(BitModel& model) {
    const std::uint32_t middle = model.zero() * (length_ >> 13U);
    const bool bit = value_ >= middle;
    value_ -= bit ? middle : 0;
    length_ = bit ? length_ - middle : middle;
    renormalise();
    model.count(bit);
    return bit;
  }

  /// A number of 1 to 32 bits that has no model.
  [[gnu::always_inline]] std::uint32_t raw(unsigned bits) {
    if (bits > kMostRaw) [[unlikely]] {
      const std::uint32_t low = few_raw(16);
      return low | few_raw(bits - 16) << 16U;
    }
    return few_raw(bits);
  }

  /// A number of 64 bits that has no model.
  [[gnu::always_inline]] std::uint64_t raw64() {
    std::uint64_t number = 0;
    for (unsigned shift = 0; shift < 64; shift += 16) {
      number |= std::uint64_t{few_raw(16)} << shift;
    }
    return number;
  }

  /// What has been given and not been read.
  [[nodiscard]] std::span<const std::byte> rest() const { return {next_, end_}; }

 private:
  static constexpr std::uint32_t kLeastLength = 1U << 24U;
  static constexpr unsigned kMostRaw = 19;

  struct Bytes {
    std::uint32_t value;
    const std::byte* next;
    const std::byte* end;
  };

  [[gnu::always_inline]] std::uint32_t few_raw(unsigned bits) {
    length_ >>= bits;
    const std::uint32_t number = value_ / length_;
    value_ -= number * length_;
    renormalise();
    if (number >> bits != 0) [[unlikely]] {
      throw_corrupt();
    }
    return number;
  }

  /// Takes as many bytes as bring the length back to 2^24 or more. One is common and unpredictable,
  /// so taken without a branch; more are rare.
  [[gnu::always_inline]] void renormalise() {
    if (next_ != end_) [[likely]] {
      const std::uint32_t longer = value_ << 8U | std::to_integer<std::uint32_t>(*next_);
      next_ += length_ < kLeastLength ? 1 : 0;
      value_ = select_if_below(length_, kLeastLength, longer, value_);
      length_ = select_if_below(length_, kLeastLength, length_ << 8U, length_);
    }
    if (length_ < kLeastLength) [[unlikely]] {
      unsigned missing = 0;
      for (; length_ < kLeastLength; length_ <<= 8U) ++missing;
      const Bytes bytes = take({value_, next_, end_}, missing, source_);
      value_ = bytes.value;
      next_ = bytes.next;
      end_ = bytes.end;
    }
  }

  /// Appends `count` bytes to the value, from the next span where this one ends.
  static Bytes take(Bytes bytes, unsigned count, LazBytes* source);
  [[noreturn]] static void throw_corrupt();

  std::uint32_t value_ = 0;
  std::uint32_t length_ = 0xFFFFFFFF;  // above value_
  const std::byte* next_ = nullptr;
  const std::byte* end_ = nullptr;
  LazBytes* source_ = nullptr;
};

}  // namespace spillway::formats::laz
