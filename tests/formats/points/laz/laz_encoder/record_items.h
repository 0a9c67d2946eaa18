#pragma once
// The parts of a record, read as a whole.

#include <cstddef>
#include <cstdint>
#include <memory>

#include "formats/bytes/bytes.h"
#include "formats/points/las/laz_record.h"
#include "formats/points/laz/coding/arithmetic_decoder.h"

namespace spillway::detail::testing {

/// A part of the record.
class ItemDecoder {
 public:
  virtual ~ItemDecoder() = default;
  /// `part` is that of the last record, and becomes that of the next one.
  virtual void decode(laz::ArithmeticDecoder& stream, std::byte* part) = 0;
};

/// An item of a pointwise chunk whose first record has this part. Throws Error for version 1.
std::unique_ptr<ItemDecoder> make_pointwise_decoder(const LazItem& item, const std::byte* first);

/// The layers of items behind POINT14, and that of its times.
std::unique_ptr<ItemDecoder> make_layered_time_decoder(const std::byte* first);
std::unique_ptr<ItemDecoder> make_rgb_decoder();
std::unique_ptr<ItemDecoder> make_nir_decoder();
std::unique_ptr<ItemDecoder> make_wave_packet_decoder();
std::unique_ptr<ItemDecoder> make_byte_decoder();

inline void put_byte(std::byte* part, std::size_t at, unsigned value) {
  part[at] = static_cast<std::byte>(value & 0xFFU);
}

inline void put_short(std::byte* part, std::size_t at, std::uint32_t value) {
  store(part + at, static_cast<std::uint16_t>(value));
}

}  // namespace spillway::detail::testing
