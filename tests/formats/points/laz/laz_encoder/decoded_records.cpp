#include "tests/formats/points/laz/laz_encoder/decoded_records.h"

#include <algorithm>
#include <utility>

#include "src/error.h"

namespace spillway::test {
namespace {

class MemoryBytes : public LazBytes {
 public:
  explicit MemoryBytes(std::span<const std::byte> bytes) : bytes_(bytes) {}
  std::span<const std::byte> more() override { return std::exchange(bytes_, {}); }

 private:
  std::span<const std::byte> bytes_;
};

}  // namespace

std::size_t record_length_of(const LazChunkFormat& format) {
  std::size_t length = 0;
  for (const LazItem& item : format.items) length += item.size;
  return length;
}

std::string decode_laz_records(LazChunkDecoder& decoder, std::size_t record_length,
                               std::span<const std::byte> chunk, std::uint64_t count,
                               std::uint64_t at_a_time) {
  MemoryBytes bytes(chunk);
  decoder.begin(bytes, count);
  std::string records(count * record_length, '\0');
  std::span<std::byte> left = std::as_writable_bytes(std::span(records));
  while (!left.empty()) {
    const std::span<std::byte> some =
        left.first(std::min<std::uint64_t>(at_a_time, left.size() / record_length) * record_length);
    decoder.decode_records(some);
    left = left.subspan(some.size());
  }
  if (decoder.end() > 0) throw Failure("the chunk is longer than its records");
  return records;
}

std::string decode_laz_records(const LazChunkFormat& format, std::span<const std::byte> chunk,
                               std::uint64_t count) {
  LazChunkDecoder decoder(format, LazDetail::kRecords);
  return decode_laz_records(decoder, record_length_of(format), chunk, count);
}

}  // namespace spillway::test
