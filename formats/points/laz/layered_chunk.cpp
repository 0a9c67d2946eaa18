#include "formats/points/laz/layered_chunk.h"

#include <algorithm>

#include "formats/bytes/bytes.h"
#include "formats/points/las/laz_record.h"
#include "src/error.h"

namespace spillway::formats::laz {

LayeredChunk::LayeredChunk(const LazChunkFormat& format, LazDetail detail)
    : layer_count_(laz_layers(format)), wanted_layers_(laz_wanted_layers(format, detail)) {
  std::size_t record_length = 0;
  for (const LazItem& item : format.items) record_length += item.size;
  record_.resize(record_length);
  if (detail == LazDetail::kRecords) others_.emplace(format);
}

void LayeredChunk::begin(LazBytes& bytes, std::uint64_t count) {
  input_ = ChunkInput(bytes);
  const std::size_t sizes_at = record_.size() + 4;
  const std::span<const std::byte> head = input_.take(sizes_at + 4 * layer_count_, head_);
  std::ranges::copy(head.first(record_.size()), record_.begin());
  if (load<std::uint32_t>(head.data() + record_.size()) != count) {
    throw Failure("the compressed chunk says another number of points than the file");
  }
  sizes_.assign(std::max(wanted_layers_, Point14Layers::kLayers), 0);
  std::size_t wanted = 0;
  skipped_ = 0;
  for (std::size_t i = 0; i < layer_count_; ++i) {
    const auto size = load<std::uint32_t>(head.data() + sizes_at + 4 * i);
    if (i < wanted_layers_) {
      sizes_[i] = size;
      wanted += size;
    } else {
      skipped_ += size;
    }
  }
  const std::span<const std::size_t> sizes(sizes_);
  const std::span<const std::byte> others =
      points_.begin(Point14::of_record(record_.data()), input_.take(wanted, layers_),
                    sizes.first<Point14Layers::kLayers>(), count);
  if (others_) others_->begin(record_.data(), others, sizes.subspan(Point14Layers::kLayers));
  at_first_ = true;
}

void LayeredChunk::decode(std::span<LatticePoint> points, std::span<LasFlags> attributes) {
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

void LayeredChunk::decode_records(std::span<std::byte> records) {
  for (; !records.empty(); records = records.subspan(record_.size())) {
    if (!at_first_) {
      points_.decode();
      points_.point().store_in(record_.data());
      others_->decode(points_.point(), points_.changes(), record_.data());
    }
    at_first_ = false;
    std::ranges::copy(record_, records.begin());
  }
}

std::size_t LayeredChunk::end() {
  points_.end();
  if (others_) others_->end();
  input_.skip(skipped_);
  return input_.rest().size();
}

}  // namespace spillway::formats::laz
