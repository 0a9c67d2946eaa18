#include "formats/points/laz/coding/models.h"

#include <algorithm>

namespace spillway::formats::laz {
namespace {

constexpr std::uint32_t kMostBits = 1U << 13U;
constexpr std::uint32_t kMostSymbols = 1U << 15U;

}  // namespace

void BitModel::update() {
  total_ += cycle_;
  if (total_ > kMostBits) {
    total_ = (total_ + 1) >> 1U;
    zeros_ = (zeros_ + 1) >> 1U;
    if (zeros_ == total_) ++total_;
  }
  zero_ = (zeros_ * (0x80000000U / total_)) >> 18U;
  cycle_ = std::min((5 * cycle_) >> 2U, 64U);
  until_update_ = cycle_;
}

void ModelCycle::start(std::uint32_t symbols_now, std::uint16_t* counts, std::uint16_t* upper) {
  symbols = symbols_now;
  std::fill_n(counts, symbols, std::uint16_t{1});
  total = 0;
  cycle = symbols;
  renew(counts, upper);
  cycle = until_update = (symbols + 6) >> 1U;
}

void ModelCycle::renew(std::uint16_t* counts, std::uint16_t* upper) {
  total += cycle;
  if (total > kMostSymbols) {
    total = 0;
    for (std::uint32_t s = 0; s < symbols; ++s) {
      counts[s] = static_cast<std::uint16_t>((counts[s] + 1U) >> 1U);
      total += counts[s];
    }
  }
  const std::uint32_t scale = 0x80000000U / total;
  std::uint32_t sum = 0;
  for (std::uint32_t s = 0; s + 1 < symbols; ++s) {
    sum += counts[s];
    upper[s] = static_cast<std::uint16_t>((scale * sum) >> 16U);
  }
  cycle = std::min((5 * cycle) >> 2U, (symbols + 6) << 3U);
  until_update = cycle;
}

}  // namespace spillway::formats::laz
