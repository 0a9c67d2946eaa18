#include "formats/points/laz/chunk_decoder.h"

#include <utility>
#include <variant>

#include "formats/points/laz/layered_chunk.h"
#include "formats/points/laz/pointwise_chunk.h"

namespace spillway::formats {

class LazChunkDecoder::Impl {
 public:
  using Chunk = std::variant<laz::PointwiseChunk, laz::LayeredChunk>;

  Impl(const LazChunkFormat& format, LazDetail detail)
      : chunk(format.layered ? Chunk(std::in_place_type<laz::LayeredChunk>, format, detail)
                             : Chunk(std::in_place_type<laz::PointwiseChunk>, format, detail)) {}

  Chunk chunk;
};

LazChunkDecoder::LazChunkDecoder(const LazChunkFormat& format, LazDetail detail)
    : impl_(std::make_unique<Impl>(format, detail)) {}
LazChunkDecoder::~LazChunkDecoder() = default;
LazChunkDecoder::LazChunkDecoder(LazChunkDecoder&&) noexcept = default;
LazChunkDecoder& LazChunkDecoder::operator=(LazChunkDecoder&&) noexcept = default;

void LazChunkDecoder::begin(LazBytes& bytes, std::uint64_t count) {
  std::visit([&](auto& chunk) { chunk.begin(bytes, count); }, impl_->chunk);
}

void LazChunkDecoder::decode(std::span<LatticePoint> points, std::span<LasFlags> attributes) {
  std::visit([&](auto& chunk) { chunk.decode(points, attributes); }, impl_->chunk);
}

void LazChunkDecoder::decode_records(std::span<std::byte> records) {
  std::visit([&](auto& chunk) { chunk.decode_records(records); }, impl_->chunk);
}

std::size_t LazChunkDecoder::end() {
  return std::visit([](auto& chunk) { return chunk.end(); }, impl_->chunk);
}

}  // namespace spillway::formats
