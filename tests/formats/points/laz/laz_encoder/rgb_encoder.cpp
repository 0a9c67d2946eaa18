#include <algorithm>
#include <array>

#include "tests/formats/points/laz/laz_encoder/fields.h"
#include "tests/formats/points/laz/laz_encoder/integer_compressor.h"
#include "tests/formats/points/laz/laz_encoder/item_encoder.h"

namespace spillway::detail::testing {
namespace {

/// A bit for each byte that differs.
unsigned changed_bytes(std::string_view part, std::string_view last) {
  unsigned changed = 0;
  for (std::size_t i = 0; i < part.size(); ++i) {
    if (part[i] != last[i]) changed |= 1U << i;
  }
  return changed;
}

class RgbVersion1 : public ItemEncoder {
 public:
  void encode(ArithmeticEncoder& encoder, std::string_view part, std::string_view last) override {
    const unsigned changed = changed_bytes(part, last);
    encoder.symbol(changed, changed_);
    for (std::size_t i = 0; i < 6; ++i) {
      if ((changed >> i & 1) != 0) {
        values_.encode(encoder, byte_at(last, i), byte_at(part, i), i);
      }
    }
  }

 private:
  SymbolModel changed_{64};
  IntegerCompressor values_{8, 6};
};

class RgbVersion2 : public ItemEncoder {
 public:
  void encode(ArithmeticEncoder& encoder, std::string_view part, std::string_view last) override {
    const bool colour =
        part.substr(0, 2) != part.substr(2, 2) || part.substr(0, 2) != part.substr(4);
    const unsigned changed = changed_bytes(part, last) | (colour ? 64 : 0);
    encoder.symbol(changed, changed_);
    const auto put = [&](std::size_t at, int prediction) {
      if ((changed >> at & 1) == 0) return;
      encoder.symbol((byte_at(part, at) - std::clamp(prediction, 0, 255)) & 0xff, differences_[at]);
    };
    put(0, byte_at(last, 0));
    put(1, byte_at(last, 1));
    if (!colour) return;
    // Green moves as red did, and blue as the two did on average: low bytes, then high ones.
    for (std::size_t at = 0; at < 2; ++at) {
      const int red = byte_at(part, at) - byte_at(last, at);
      const int green = byte_at(part, at + 2) - byte_at(last, at + 2);
      put(at + 2, red + byte_at(last, at + 2));
      put(at + 4, (red + green) / 2 + byte_at(last, at + 4));
    }
  }

 private:
  SymbolModel changed_{128};
  SymbolModels differences_{6, 256};
};

class Nir : public ItemEncoder {
 public:
  void encode(ArithmeticEncoder& encoder, std::string_view part, std::string_view last) override {
    const unsigned changed = changed_bytes(part, last);
    encoder.symbol(changed, changed_);
    for (std::size_t i = 0; i < 2; ++i) {
      if ((changed >> i & 1) != 0) {
        encoder.symbol((byte_at(part, i) - byte_at(last, i)) & 0xff, differences_[i]);
      }
    }
  }

 private:
  SymbolModel changed_{4};
  SymbolModels differences_{2, 256};
};

}  // namespace

std::unique_ptr<ItemEncoder> make_rgb_encoder(int version) {
  if (version == 1) return std::make_unique<RgbVersion1>();
  return std::make_unique<RgbVersion2>();
}

std::unique_ptr<ItemEncoder> make_nir_encoder() { return std::make_unique<Nir>(); }

}  // namespace spillway::detail::testing
