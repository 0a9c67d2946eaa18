#pragma once
// The entropy coder of LAZ, writing side: the mirror of docs/formats-laz.md, made for tests. It
// shares nothing with the decoder, so that a mistake in one of them shows.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace spillway::detail::testing {

/// Adaptive probability of a bit.
class BitModel {
 public:
  /// Probability of 0, in 1/8192.
  [[nodiscard]] std::uint32_t zero() const { return zero_; }
  void count(unsigned bit);

 private:
  std::uint32_t zero_ = 4096;
  std::uint32_t zeros_ = 1;
  std::uint32_t total_ = 2;
  std::uint32_t cycle_ = 4;
  std::uint32_t left_ = 4;
};

/// Adaptive probabilities of the symbols 0 ... n - 1.
class SymbolModel {
 public:
  explicit SymbolModel(std::uint32_t symbols);

  [[nodiscard]] bool is_last(std::uint32_t symbol) const { return symbol + 1 == counts_.size(); }
  /// Sum of the probabilities of all symbols before this one, in 1/32768.
  [[nodiscard]] std::uint32_t start(std::uint32_t symbol) const { return starts_[symbol]; }
  void count(std::uint32_t symbol);

 private:
  void update();

  std::vector<std::uint32_t> counts_;
  std::vector<std::uint32_t> starts_;
  std::uint32_t total_ = 0;
  std::uint32_t cycle_;
  std::uint32_t left_ = 0;
};

/// An array of models of the same size, each made when it is first used.
class SymbolModels {
 public:
  SymbolModels(std::size_t models, std::uint32_t symbols) : models_(models), symbols_(symbols) {}
  SymbolModel& operator[](std::size_t i) {
    if (!models_.at(i)) models_[i].emplace(symbols_);
    return *models_[i];
  }

 private:
  std::vector<std::optional<SymbolModel>> models_;
  std::uint32_t symbols_;
};

/// Writes one arithmetic stream.
class ArithmeticEncoder {
 public:
  void bit(unsigned bit, BitModel& model);
  void symbol(std::uint32_t symbol, SymbolModel& model);
  /// The lowest `bits` (1 to 32) bits of `value`, which has no others.
  void raw(std::uint32_t value, unsigned bits);
  void raw64(std::uint64_t value);

  /// Ends the stream so that a decoder takes its last byte with the last symbol.
  std::string finish();

 private:
  void narrow(std::uint32_t low, std::uint32_t length);

  std::string bytes_;
  std::uint32_t base_ = 0;
  std::uint32_t length_ = 0xffffffff;
};

}  // namespace spillway::detail::testing
