#pragma once
// Adaptive models of the arithmetic coder: how likely which bit or symbol is, learnt from those
// decoded so far.

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <type_traits>
#include <vector>

#include "formats/points/laz/coding/select.h"

namespace spillway::formats::laz {

/// The likelihood of a bit.
class BitModel {
 public:
  /// Of 2^13, how likely a 0 is.
  [[nodiscard]] std::uint32_t zero() const { return zero_; }

  void count(bool bit) {
    zeros_ += bit ? 0 : 1;
    if (--until_update_ == 0) update();
  }

 private:
  void update();

  std::uint32_t zeros_ = 1;
  std::uint32_t total_ = 2;
  std::uint32_t zero_ = 4096;
  std::uint32_t cycle_ = 4;
  std::uint32_t until_update_ = 4;
};

/// When a symbol model renews its distribution.
struct ModelCycle {
  std::uint32_t symbols = 0;
  std::uint32_t total = 0;
  std::uint32_t cycle = 0;
  std::uint32_t until_update = 0;

  /// A model of which nothing is known but the number of its symbols.
  void start(std::uint32_t symbols_now, std::uint16_t* counts, std::uint16_t* upper);
  /// Makes the distribution of the counts: for all symbols but the last, where its share ends.
  void renew(std::uint16_t* counts, std::uint16_t* upper);
};

/// Where a number falls in a distribution.
struct SymbolFound {
  unsigned symbol;
  std::uint32_t low;   ///< of 2^15, how likely the symbols below are
  std::uint32_t high;  ///< and with this one; more for the last symbol
};

/// The likelihoods of at most Most symbols. A table over the upper bits of a number says which
/// symbol it has at least; as its steps are narrow, it is nearly always that one or one of the next
/// kTried, which are tried without a branch: a branch predictor knows nothing of the symbols, else
/// they would have been compressed. Tried and slower: bisection, and SSE2 comparisons with all
/// bounds (vectors take long to come back to integer registers). Likelihoods take 15 bits and
/// counts 16, so a model of 256 symbols takes 1.2 KB.
template <unsigned Most>
class SymbolModel {
 public:
  explicit SymbolModel(unsigned symbols) {
    bounds_.fill(kNever);
    bounds_[0] = 0;
    counts_.fill(0);
    cycle_.start(symbols, counts_.data(), bounds_.data() + 1);
    fill_table();
  }

  /// The symbol whose share of [0, 2^15) has `number` (a little more for the last one) in it.
  [[nodiscard]] [[gnu::always_inline]] SymbolFound find(std::uint32_t number) const {
    unsigned symbol = table_[number >> kShift];
    const std::uint16_t* upper = bounds_.data() + 1 + symbol;
    for (; upper[kTried] <= number; ++upper) ++symbol;
    std::uint32_t low = upper[-1];
    std::uint32_t high = upper[0];
    std::uint32_t found = symbol;
    for (unsigned i = 0; i < kTried; ++i) {
      const std::uint32_t bound = upper[i];
      found = select_if_below(number, bound, found, symbol + i + 1);
      low = select_if_below(number, bound, low, bound);
      high = select_if_below(number, bound, high, upper[i + 1]);
    }
    return {found, low, high};
  }

  [[nodiscard]] std::uint32_t symbols() const { return cycle_.symbols; }

  [[gnu::always_inline]] void count(unsigned symbol) {
    ++counts_[symbol];
    if (--cycle_.until_update == 0) update();
  }

  [[nodiscard]] const ModelCycle& cycle() const { return cycle_; }
  /// Of 2^15, how likely the symbols below `symbol` are.
  [[nodiscard]] std::uint32_t below(unsigned symbol) const { return bounds_[symbol]; }

 private:
  static constexpr std::uint16_t kNever = 0xFFFF;  // above every number that is looked for
  static constexpr unsigned kTried = 2;
  static constexpr unsigned kTableBits = Most <= 16 ? 5 : Most <= 64 ? 6 : 7;
  static constexpr unsigned kShift = 15 - kTableBits;

  [[gnu::noinline]] void update() {
    cycle_.renew(counts_.data(), bounds_.data() + 1);
    fill_table();
  }

  void fill_table() {
    table_.fill(0);
    for (unsigned s = 1; s < cycle_.symbols; ++s) {
      table_[(bounds_[s] >> kShift) + 1] = static_cast<Symbol>(s);
    }
    for (std::size_t i = 1; i < table_.size(); ++i) table_[i] = std::max(table_[i], table_[i - 1]);
  }

  using Symbol = std::conditional_t<(Most > 256), std::uint16_t, std::uint8_t>;

  ModelCycle cycle_;
  /// By the upper bits of a number, which reach 2^kTableBits: the symbol that it has at least.
  std::array<Symbol, (1U << kTableBits) + 1> table_;
  /// 0, where the share of each symbol but the last ends, then numbers above all.
  std::array<std::uint16_t, Most + kTried + 1> bounds_;
  std::array<std::uint16_t, Most> counts_;
};

/// Symbol models by context, made when they are first used and used again in the next chunk.
template <unsigned Most>
class SymbolModels {
 public:
  explicit SymbolModels(std::size_t contexts) : slots_(contexts) {}

  /// All models are as new.
  void reset() { ++chunk_; }

  /// The model of a context; `symbols` must be the same at every use.
  [[gnu::always_inline]] SymbolModel<Most>& at(std::size_t context, unsigned symbols = Most) {
    Slot& slot = slots_[context];
    if (slot.chunk != chunk_) [[unlikely]] {
      start(slot, symbols);
    }
    return *slot.model;
  }

 private:
  struct Slot {
    std::unique_ptr<SymbolModel<Most>> model;
    std::uint64_t chunk = 0;
  };

  [[gnu::noinline]] void start(Slot& slot, unsigned symbols) {
    // Chunks may be small, and copying is much faster than making a new one.
    static const SymbolModel<Most> fresh(Most);
    if (!slot.model) slot.model = std::make_unique<SymbolModel<Most>>(fresh);
    *slot.model = symbols == Most ? fresh : SymbolModel<Most>(symbols);
    slot.chunk = chunk_;
  }

  std::vector<Slot> slots_;
  std::uint64_t chunk_ = 1;
};

}  // namespace spillway::formats::laz
