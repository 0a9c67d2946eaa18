#pragma once
// The parts of a record, in the versions that are written: 2, or 1 of wave packets.

#include <cstddef>
#include <memory>

#include "formats/points/las/laz_record.h"
#include "formats/points/laz/encoding/arithmetic_encoder.h"

namespace spillway::formats::laz {

/// The models of one part of a record: of a pointwise item, or of a layer after the first nine.
class ItemEncoder {
 public:
  virtual ~ItemEncoder() = default;
  /// Begins a chunk, or a scanner channel's share of a layer, after its first point.
  virtual void reset(const std::byte* first) = 0;
  /// Encodes the part of one record, predicted from the part of another one.
  virtual void encode(ArithmeticEncoder& stream, const std::byte* part, const std::byte* last) = 0;
};

/// Throws Failure for an item that is not pointwise, and for versions that are not written.
std::unique_ptr<ItemEncoder> make_item_encoder(const LazItem& item);

std::unique_ptr<ItemEncoder> make_point10_encoder();
std::unique_ptr<ItemEncoder> make_gps_time_encoder();
/// Also the layer of RGB14 and RGBNIR14.
std::unique_ptr<ItemEncoder> make_rgb_encoder();
/// The NIR layer of RGBNIR14.
std::unique_ptr<ItemEncoder> make_nir_encoder();
/// Also the layer of WavePacket14.
std::unique_ptr<ItemEncoder> make_wave_packet_encoder();
/// Also a layer of Byte14, with one byte.
std::unique_ptr<ItemEncoder> make_bytes_encoder(std::size_t bytes);

}  // namespace spillway::formats::laz
