#pragma once
// The nine layers of POINT14, and the contexts of the scanner channels.

#include <array>
#include <memory>
#include <string>
#include <string_view>

#include "tests/formats/points/laz/laz_encoder/arithmetic_encoder.h"

namespace spillway::detail::testing {

/// One layer of a chunk.
struct LayerStream {
  ArithmeticEncoder encoder;
  bool changes = false;  ///< whether a point differs from the first one in what the layer holds

  /// The layer's bytes: none if nothing changes, unless `always`.
  std::string finish(bool always) { return changes || always ? encoder.finish() : ""; }
};

/// Where the scanner channel of a point is, and whether it changed with it.
struct ChannelStep {
  unsigned channel = 0;
  bool switched = false;
};

class Point14Encoder {
 public:
  enum Layer {
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

  explicit Point14Encoder(std::string_view first);
  ~Point14Encoder();

  ChannelStep encode(std::string_view point);

  std::array<LayerStream, kLayers>& layers() { return layers_; }

 private:
  struct Context;
  struct Pulse;

  /// Encodes the layer of channel, returns, x and y; leaves `channel_` at the point's.
  Pulse encode_xy(std::string_view point);
  static void encode_returns(ArithmeticEncoder& encoder, Context& context, std::string_view point,
                             Pulse& pulse);
  void encode_rest(std::string_view point, const Pulse& pulse);

  std::array<LayerStream, kLayers> layers_;
  std::array<std::unique_ptr<Context>, 4> contexts_;
  unsigned channel_;
};

}  // namespace spillway::detail::testing
