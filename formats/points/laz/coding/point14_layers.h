#pragma once
// The layers of the first item of a layered chunk: docs/formats-laz.md.

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "formats/points/laz/coding/by_channel.h"
#include "formats/points/laz/coding/integer_decoder.h"
#include "formats/points/laz/coding/layer.h"
#include "formats/points/laz/coding/streaming_median.h"

namespace spillway::formats::laz {

/// What the first layers hold of the first 30 bytes of a record.
struct Point14 {
  std::int32_t x = 0;
  std::int32_t y = 0;
  std::int32_t z = 0;
  std::uint8_t return_number = 0;
  std::uint8_t return_count = 0;
  std::uint8_t channel = 0;  ///< of the scanner, 0 to 3
  std::uint8_t flags = 0;    ///< bits 0-3 as in LasFlags, 4: direction, 5: edge
  std::uint8_t classification = 0;

  /// Reads a record as it is without compression.
  static Point14 of_record(const std::byte* record);
  /// Writes these fields likewise.
  void store_in(std::byte* record) const;
};

/// What the first layer says of a point besides its fields.
struct Point14Changes {
  bool channel = false;
  bool time = false;
  bool angle = false;
  bool source = false;
};

/// Decodes coordinates, returns, classification and flags; no layer depends on those after it, so
/// the others may be left out. Each scanner channel has its own models and last point.
class Point14Layers {
 public:
  static constexpr std::size_t kCoordinateLayers = 2;  ///< x, y and returns; z
  static constexpr std::size_t kLayers = 4;            ///< also classification; flags

  /// Begins a chunk. `layers` begins with the bytes of these layers one after the other; returns
  /// those after them. A layer of size 0 leaves its values as they are in the first point.
  std::span<const std::byte> begin(const Point14& first, std::span<const std::byte> layers,
                                   std::span<const std::size_t, kLayers> sizes,
                                   std::uint64_t count);

  /// The next point.
  void decode();

  /// The point decoded last, at first the chunk's first one.
  [[nodiscard]] const Point14& point() const { return current_->last; }

  /// What changed with it.
  [[nodiscard]] Point14Changes changes() const;

  /// Checks that all layers have been read to their ends.
  void end() const;

 private:
  struct Context {
    void begin(const Point14& point);

    SymbolModels<128> changes{8};
    SymbolModels<3> channel{1};
    SymbolModels<16> return_count{16};
    SymbolModels<16> return_number{16};
    SymbolModels<13> return_step{1};
    IntegerDecoder<32> dx{2};
    IntegerDecoder<32> dy{22};
    IntegerDecoder<32> z{20};
    SymbolModels<256> classification{64};
    SymbolModels<64> flags{64};
    std::array<StreamingMedian, 12> dx_median{};
    std::array<StreamingMedian, 12> dy_median{};
    std::array<std::int32_t, 8> last_z{};
    Point14 last;
    unsigned changed = 0;  // with the last point
  };

  std::array<Layer, kLayers> layers_;
  ByChannel<Context> contexts_;
  Context* current_ = nullptr;
};

}  // namespace spillway::formats::laz
