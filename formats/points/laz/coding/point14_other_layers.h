#pragma once
// The other layers of the first item of a layered chunk: docs/formats-laz.md.

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "formats/points/laz/coding/by_channel.h"
#include "formats/points/laz/coding/gps_times.h"
#include "formats/points/laz/coding/integer_decoder.h"
#include "formats/points/laz/coding/layer.h"
#include "formats/points/laz/coding/point14_layers.h"

namespace spillway::formats::laz {

/// Decodes intensity, scan angle, user data, point source and GPS time: what only whole records
/// need of their first 30 bytes.
class Point14OtherLayers {
 public:
  static constexpr std::size_t kLayers = 5;

  /// Begins a chunk with its first record. `layers` begins with the bytes of these layers one after
  /// the other; returns those after them.
  std::span<const std::byte> begin(const std::byte* first, std::span<const std::byte> layers,
                                   std::span<const std::size_t, kLayers> sizes);

  /// Puts these fields of the next point into its record. Point14Layers gave the point.
  void decode(const Point14& point, const Point14Changes& changes, std::byte* record);

  /// Checks that all layers have been read to their ends.
  void end() const;

 private:
  struct Fields {
    std::uint16_t intensity = 0;
    std::uint16_t angle = 0;
    std::uint8_t user = 0;
    std::uint16_t source = 0;
    std::uint64_t time = 0;
  };

  /// Of a scanner channel.
  struct Context {
    void begin(const Fields& first);

    IntegerDecoder<16> intensity{4};
    IntegerDecoder<16> angle{2};
    SymbolModels<256> user{64};
    IntegerDecoder<16> source{1};
    GpsTimeDecoder<true, Keep::kWhole> time;
    std::array<std::uint16_t, 8> last_intensity{};  // of pulses of a kind
    Fields last;
  };

  std::array<Layer, kLayers> layers_;
  ByChannel<Context> contexts_;
  Context* current_ = nullptr;
};

}  // namespace spillway::formats::laz
