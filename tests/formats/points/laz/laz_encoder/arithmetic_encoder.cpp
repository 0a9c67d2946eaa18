#include "tests/formats/points/laz/laz_encoder/arithmetic_encoder.h"

#include <algorithm>

namespace spillway::detail::testing {
namespace {

constexpr std::uint32_t kMinLength = 0x01000000;

}  // namespace

void BitModel::count(unsigned bit) {
  if (bit == 0) ++zeros_;
  if (--left_ > 0) return;
  total_ += cycle_;
  if (total_ > 8192) {
    total_ = (total_ + 1) >> 1;
    zeros_ = (zeros_ + 1) >> 1;
    if (zeros_ == total_) ++total_;
  }
  zero_ = (zeros_ * (0x80000000 / total_)) >> 18;
  cycle_ = std::min((5 * cycle_) >> 2, 64U);
  left_ = cycle_;
}

SymbolModel::SymbolModel(std::uint32_t symbols)
    : counts_(symbols, 1), starts_(symbols), cycle_(symbols) {
  update();
  cycle_ = left_ = (symbols + 6) >> 1;
}

void SymbolModel::count(std::uint32_t symbol) {
  ++counts_[symbol];
  if (--left_ == 0) update();
}

void SymbolModel::update() {
  total_ += cycle_;
  if (total_ > 32768) {
    total_ = 0;
    for (std::uint32_t& count : counts_) {
      count = (count + 1) >> 1;
      total_ += count;
    }
  }
  const std::uint32_t scale = 0x80000000 / total_;
  std::uint32_t sum = 0;
  for (std::size_t s = 0; s < counts_.size(); ++s) {
    starts_[s] = (scale * sum) >> 16;
    sum += counts_[s];
  }
  cycle_ = std::min<std::uint32_t>((5 * cycle_) >> 2,
                                   (static_cast<std::uint32_t>(counts_.size()) + 6) << 3);
  left_ = cycle_;
}

void ArithmeticEncoder::bit(unsigned bit, BitModel& model) {
  const std::uint32_t split = model.zero() * (length_ >> 13);
  if (bit == 0) {
    narrow(0, split);
  } else {
    narrow(split, length_ - split);
  }
  model.count(bit);
}

void ArithmeticEncoder::symbol(std::uint32_t symbol, SymbolModel& model) {
  const std::uint32_t unit = length_ >> 15;
  const std::uint32_t low = unit * model.start(symbol);
  const std::uint32_t high = model.is_last(symbol) ? length_ : unit * model.start(symbol + 1);
  narrow(low, high - low);
  model.count(symbol);
}

void ArithmeticEncoder::raw(std::uint32_t value, unsigned bits) {
  if (bits > 19) {
    raw(value & 0xffff, 16);
    raw(value >> 16, bits - 16);
    return;
  }
  const std::uint32_t unit = length_ >> bits;
  narrow(value * unit, unit);
}

void ArithmeticEncoder::raw64(std::uint64_t value) {
  raw(static_cast<std::uint32_t>(value), 32);
  raw(static_cast<std::uint32_t>(value >> 32), 32);
}

void ArithmeticEncoder::narrow(std::uint32_t low, std::uint32_t length) {
  const std::uint32_t before = base_;
  base_ += low;
  length_ = length;
  if (base_ < before) {  // a carry into the bytes that were already written
    std::size_t at = bytes_.size() - 1;
    while (bytes_[at] == '\xff') bytes_[at--] = '\0';
    ++bytes_[at];
  }
  while (length_ < kMinLength) {
    bytes_ += static_cast<char>(base_ >> 24);
    base_ <<= 8;
    length_ <<= 8;
  }
}

std::string ArithmeticEncoder::finish() {
  // The decoder is four bytes ahead: those that end the interval, and zeros that nobody looks at.
  const bool wide = length_ > 2 * kMinLength;
  narrow(wide ? kMinLength : kMinLength >> 1, wide ? kMinLength >> 1 : kMinLength >> 9);
  bytes_.append(wide ? 3 : 2, '\0');
  return std::move(bytes_);
}

}  // namespace spillway::detail::testing
