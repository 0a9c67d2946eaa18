#pragma once
// The parts of a record, by LAZ item type and version.

#include <memory>
#include <string_view>

#include "formats/points/laz/chunk_decoder.h"
#include "tests/formats/points/laz/laz_encoder/arithmetic_encoder.h"

namespace spillway::detail::testing {

/// The models of one part of a record (an item, or a layer of one) in one chunk or context.
class ItemEncoder {
 public:
  virtual ~ItemEncoder() = default;
  /// Encodes the part of one record, predicted from the part of another one.
  virtual void encode(ArithmeticEncoder& encoder, std::string_view part, std::string_view last) = 0;
};

/// For an item of a pointwise chunk whose first record has this part.
std::unique_ptr<ItemEncoder> make_item_encoder(const LazItem& item, std::string_view first);

std::unique_ptr<ItemEncoder> make_point10_encoder(int version);
std::unique_ptr<ItemEncoder> make_gps_time_encoder(int version, std::string_view first);
/// Also the layer of RGB14 and RGBNIR14, with version 2.
std::unique_ptr<ItemEncoder> make_rgb_encoder(int version);
/// The NIR layer of RGBNIR14.
std::unique_ptr<ItemEncoder> make_nir_encoder();
std::unique_ptr<ItemEncoder> make_wave_packet_encoder();
/// Also a layer of BYTE14, with version 2 and one byte.
std::unique_ptr<ItemEncoder> make_bytes_encoder(int version, std::size_t bytes);

}  // namespace spillway::detail::testing
