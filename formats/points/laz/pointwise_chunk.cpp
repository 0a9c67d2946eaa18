#include "formats/points/laz/pointwise_chunk.h"

#include "formats/bytes/bytes.h"
#include "formats/points/laz/chunk_input.h"
#include "formats/points/laz/coding/items_v1.h"
#include "formats/points/laz/coding/items_v2.h"
#include "src/error.h"

namespace spillway::detail::laz {
namespace {

std::unique_ptr<Point10Item> make_point(const LazItem& item) {
  if (item.type != LazItemType::kPoint10) throw Error("the compressed record begins with no point");
  if (item.version == 1) return std::make_unique<Point10V1>();
  return std::make_unique<Point10V2>();
}

std::unique_ptr<PointwiseItem> make_item(const LazItem& item) {
  const bool first_version = item.version == 1;
  switch (item.type) {
    case LazItemType::kGpsTime11:
      if (first_version) return std::make_unique<GpsTime11V1>();
      return std::make_unique<GpsTime11V2>();
    case LazItemType::kRgb12:
      if (first_version) return std::make_unique<Rgb12V1>();
      return std::make_unique<Rgb12V2>();
    case LazItemType::kWavePacket13:
      return std::make_unique<WavePacket13>();
    case LazItemType::kByte:
      if (first_version) return std::make_unique<ByteV1>(item.size);
      return std::make_unique<ByteV2>(item.size);
    default:
      throw Error("the compressed record has a part that does not belong there");
  }
}

}  // namespace

Point10 Point10::of_record(const std::byte* record) {
  Point10 point;
  point.x = load<std::int32_t>(record);
  point.y = load<std::int32_t>(record + 4);
  point.z = load<std::int32_t>(record + 8);
  point.returns = load<std::uint8_t>(record + 14);
  point.classification = load<std::uint8_t>(record + 15);
  point.user = load<std::uint8_t>(record + 17);
  return point;
}

PointwiseChunk::PointwiseChunk(const LazChunkFormat& format)
    : point_(make_point(format.items.at(0))) {
  for (const LazItem& item : format.items) {
    if (record_length_ > 0) others_.push_back(make_item(item));
    record_length_ += item.size;
  }
}

void PointwiseChunk::begin(LazBytes& bytes, std::uint64_t /*count*/) {
  ChunkInput input(bytes);
  point_->reset();
  point_->point = Point10::of_record(input.take(record_length_, first_record_).data());
  for (const auto& item : others_) item->reset();
  at_first_ = true;
  stream_ = ArithmeticDecoder(input.rest(), &bytes);
}

void PointwiseChunk::decode(std::span<LatticePoint> points, std::span<PointAttributes> attributes) {
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (!at_first_) {
      point_->decode(stream_);
      for (const auto& item : others_) item->decode(stream_);
    }
    at_first_ = false;
    const Point10& point = point_->point;
    points[i] = {static_cast<double>(point.x), static_cast<double>(point.y),
                 static_cast<double>(point.z)};
    if (!attributes.empty()) {
      attributes[i] = {.classification = static_cast<std::uint8_t>(point.classification & 31U),
                       .return_number = static_cast<std::uint8_t>(point.returns & 7U),
                       .return_count = static_cast<std::uint8_t>(point.returns >> 3U & 7U),
                       .flags = static_cast<std::uint8_t>(point.classification >> 5U)};
    }
  }
}

}  // namespace spillway::detail::laz
