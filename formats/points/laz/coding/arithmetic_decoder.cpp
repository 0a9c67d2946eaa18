#include "formats/points/laz/coding/arithmetic_decoder.h"

#include "formats/points/laz/coding/laz_bytes.h"
#include "src/error.h"

namespace spillway::formats::laz {

ArithmeticDecoder::ArithmeticDecoder(std::span<const std::byte> bytes, LazBytes* source)
    : source_(source) {
  const Bytes start = take({0, bytes.data(), bytes.data() + bytes.size()}, 4, source);
  value_ = start.value;
  next_ = start.next;
  end_ = start.end;
  if (value_ >= length_) throw_corrupt();
}

ArithmeticDecoder::Bytes ArithmeticDecoder::take(Bytes bytes, unsigned count, LazBytes* source) {
  for (; count > 0; --count) {
    if (bytes.next == bytes.end) {
      const std::span<const std::byte> more =
          source == nullptr ? std::span<const std::byte>() : source->more();
      if (more.empty()) throw Failure("the compressed stream ends too early");
      bytes.next = more.data();
      bytes.end = more.data() + more.size();
    }
    bytes.value = bytes.value << 8U | std::to_integer<std::uint32_t>(*bytes.next++);
  }
  return bytes;
}

void ArithmeticDecoder::throw_corrupt() { throw Failure("the compressed stream is corrupt"); }

}  // namespace spillway::formats::laz
