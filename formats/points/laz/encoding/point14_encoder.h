#pragma once
// The nine layers of POINT14, and the contexts of the scanner channels.

#include <array>
#include <cstddef>

#include "formats/points/laz/coding/by_channel.h"
#include "formats/points/laz/encoding/layer_stream.h"

namespace spillway::formats::laz {

/// Where the scanner channel of a point is, and whether it changed with it.
struct ChannelStep {
  unsigned channel = 0;
  bool switched = false;
};

/// Encodes the first 30 bytes of records.
class Point14Encoder {
 public:
  enum Layer : unsigned {
    kXyLayer,
    kZLayer,
    kClassLayer,
    kFlagsLayer,
    kIntensityLayer,
    kAngleLayer,
    kUserLayer,
    kSourceLayer,
    kGpsTimeLayer,
    kLayers
  };

  Point14Encoder();
  ~Point14Encoder();

  /// Begins a chunk with its first record.
  void reset(const std::byte* first);
  ChannelStep encode(const std::byte* point);

  [[nodiscard]] std::array<LayerStream, kLayers>& layers() { return layers_; }

 private:
  struct Context;
  struct Pulse;

  /// Encodes the layer of channel, returns, x and y; leaves `current_` at the point's.
  Pulse encode_xy(const std::byte* point);
  void encode_returns(const Pulse& pulse);
  void encode_rest(const std::byte* point, const Pulse& pulse);

  std::array<LayerStream, kLayers> layers_;
  ByChannel<Context> contexts_;
  Context* current_ = nullptr;
  unsigned channel_ = 0;
};

}  // namespace spillway::formats::laz
