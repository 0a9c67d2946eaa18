#include <algorithm>

#include "formats/points/laz/coding/record_fields.h"
#include "formats/points/laz/encoding/item_encoder.h"

namespace spillway::formats::laz {
namespace {

/// A bit for each of the first bytes that differs.
unsigned changed_bytes(const std::byte* part, const std::byte* last, std::size_t bytes) {
  unsigned changed = 0;
  for (std::size_t i = 0; i < bytes; ++i) changed |= part[i] != last[i] ? 1U << i : 0;
  return changed;
}

class RgbEncoder final : public ItemEncoder {
 public:
  void reset(const std::byte* /*first*/) override {
    changed_.reset();
    differences_.reset();
  }

  void encode(ArithmeticEncoder& stream, const std::byte* part, const std::byte* last) override {
    constexpr unsigned kColoured = 64;
    const std::uint16_t red = short_at(part, 0);
    const bool coloured = red != short_at(part, 2) || red != short_at(part, 4);
    const unsigned changed = changed_bytes(part, last, 6) | (coloured ? kColoured : 0);
    stream.symbol(changed, changed_.at(0));
    const auto put = [&](std::size_t at, int prediction) {
      if ((changed >> at & 1U) == 0) return;
      const auto predicted = static_cast<unsigned>(std::clamp(prediction, 0, 255));
      stream.symbol((byte_at(part, at) - predicted) & 0xFFU, differences_.at(at));
    };
    const auto before = [&](std::size_t at) { return static_cast<int>(byte_at(last, at)); };
    const auto step = [&](std::size_t at) {
      return static_cast<int>(byte_at(part, at)) - before(at);
    };
    put(0, before(0));
    put(1, before(1));
    if (!coloured) return;
    // Green moves as red did, and blue as the two did on average: low bytes, then high ones.
    for (std::size_t at = 0; at < 2; ++at) {
      put(at + 2, step(at) + before(at + 2));
      put(at + 4, (step(at) + step(at + 2)) / 2 + before(at + 4));
    }
  }

 private:
  SymbolModels<128> changed_{1};
  SymbolModels<256> differences_{6};
};

class NirEncoder final : public ItemEncoder {
 public:
  void reset(const std::byte* /*first*/) override {
    changed_.reset();
    differences_.reset();
  }

  void encode(ArithmeticEncoder& stream, const std::byte* part, const std::byte* last) override {
    const unsigned changed = changed_bytes(part, last, 2);
    stream.symbol(changed, changed_.at(0));
    for (std::size_t i = 0; i < 2; ++i) {
      if ((changed >> i & 1U) == 0) continue;
      stream.symbol((byte_at(part, i) - byte_at(last, i)) & 0xFFU, differences_.at(i));
    }
  }

 private:
  SymbolModels<4> changed_{1};
  SymbolModels<256> differences_{2};
};

}  // namespace

std::unique_ptr<ItemEncoder> make_rgb_encoder() { return std::make_unique<RgbEncoder>(); }

std::unique_ptr<ItemEncoder> make_nir_encoder() { return std::make_unique<NirEncoder>(); }

}  // namespace spillway::formats::laz
