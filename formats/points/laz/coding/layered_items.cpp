#include "formats/points/laz/coding/layered_items.h"

#include "formats/points/laz/coding/items_v1.h"
#include "formats/points/laz/coding/items_v2.h"
#include "src/error.h"

namespace spillway::formats::laz {
namespace {

/// An item of one layer, which has the symbols of a pointwise one.
template <typename Pointwise>
class OneLayer final : public LayeredItem {
 public:
  void reset(const std::byte* first) override { item_.reset(first); }

  void decode(std::span<Layer> layers, std::byte* part) override {
    if (layers[0].present) item_.decode(layers[0].stream, part);
  }

 private:
  Pointwise item_;
};

class RgbNirLayers final : public LayeredItem {
 public:
  void reset(const std::byte* first) override {
    rgb_.reset(first);
    used_.reset();
    differences_.reset();
  }

  void decode(std::span<Layer> layers, std::byte* part) override {
    if (layers[0].present) rgb_.decode(layers[0].stream, part);
    if (layers[1].present) decode_nir(layers[1].stream, part + kNir);
  }

 private:
  static constexpr std::size_t kNir = 6;

  void decode_nir(ArithmeticDecoder& stream, std::byte* part) {
    ArithmeticDecoder local = stream;
    const unsigned used = local.symbol(used_.at(0));
    for (const unsigned i : {0U, 1U}) {
      if ((used >> i & 1U) == 0) continue;
      put_byte(part, i, byte_at(part, i) + local.symbol(differences_.at(i)));
    }
    stream = local;
  }

  Rgb12V2<Keep::kWhole> rgb_;
  SymbolModels<4> used_{1};
  SymbolModels<256> differences_{2};
};

/// A layer for each byte.
class ByteLayers final : public LayeredItem {
 public:
  explicit ByteLayers(std::size_t bytes) : differences_(bytes) {}

  void reset(const std::byte* /*first*/) override { differences_.reset(); }

  void decode(std::span<Layer> layers, std::byte* part) override {
    for (std::size_t i = 0; i < layers.size(); ++i) {
      if (!layers[i].present) continue;
      ArithmeticDecoder local = layers[i].stream;
      put_byte(part, i, byte_at(part, i) + local.symbol(differences_.at(i)));
      layers[i].stream = local;
    }
  }

 private:
  SymbolModels<256> differences_;
};

}  // namespace

std::unique_ptr<LayeredItem> make_layered_item(const LazItem& item) {
  switch (item.type) {
    case LazItemType::kRgb14:
      return std::make_unique<OneLayer<Rgb12V2<Keep::kWhole>>>();
    case LazItemType::kRgbNir14:
      return std::make_unique<RgbNirLayers>();
    case LazItemType::kWavePacket14:
      return std::make_unique<OneLayer<WavePacket13<Keep::kWhole>>>();
    case LazItemType::kByte14:
      return std::make_unique<ByteLayers>(item.size);
    default:
      throw Failure("the compressed record has a part that does not belong there");
  }
}

}  // namespace spillway::formats::laz
