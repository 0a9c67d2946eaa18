#include "formats/points/laz/layered_chunk.h"

#include "formats/bytes/bytes.h"
#include "formats/points/las/laz_record.h"
#include "src/error.h"

namespace spillway::detail::laz {

LayeredChunk::LayeredChunk(const LazChunkFormat& format, bool attributes)
    : layer_count_(laz_layers(format)),
      wanted_layers_(attributes ? Point14Layers::kLayers : Point14Layers::kCoordinateLayers) {
  for (const LazItem& item : format.items) record_length_ += item.size;
}

void LayeredChunk::begin(LazBytes& bytes, std::uint64_t count) {
  input_ = ChunkInput(bytes);
  const std::size_t sizes_at = record_length_ + 4;
  const std::span<const std::byte> head = input_.take(sizes_at + 4 * layer_count_, head_);
  const Point14 first = Point14::of_record(head.data());
  if (load<std::uint32_t>(head.data() + record_length_) != count) {
    throw Error("the compressed chunk says another number of points than the file");
  }
  std::array<std::size_t, Point14Layers::kLayers> sizes{};
  std::size_t wanted = 0;
  skipped_ = 0;
  for (std::size_t i = 0; i < layer_count_; ++i) {
    const auto size = load<std::uint32_t>(head.data() + sizes_at + 4 * i);
    if (i < wanted_layers_) {
      sizes[i] = size;
      wanted += size;
    } else {
      skipped_ += size;
    }
  }
  points_.begin(first, input_.take(wanted, layers_), sizes, count);
  at_first_ = true;
}

void LayeredChunk::decode(std::span<LatticePoint> points, std::span<PointAttributes> attributes) {
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (!at_first_) points_.decode();
    at_first_ = false;
    const Point14& point = points_.point();
    points[i] = {static_cast<double>(point.x), static_cast<double>(point.y),
                 static_cast<double>(point.z)};
    if (!attributes.empty()) {
      attributes[i] = {.classification = point.classification,
                       .return_number = point.return_number,
                       .return_count = point.return_count,
                       .flags = static_cast<std::uint8_t>(point.flags & 15U)};
    }
  }
}

std::size_t LayeredChunk::end() {
  points_.end();
  input_.skip(skipped_);
  return input_.rest().size();
}

}  // namespace spillway::detail::laz
