#include "formats/points/laz/pointwise_chunk.h"

#include <algorithm>

#include "formats/points/laz/chunk_input.h"
#include "formats/points/laz/coding/gps_times.h"
#include "formats/points/laz/coding/items_v1.h"
#include "formats/points/laz/coding/items_v2.h"
#include "src/error.h"

namespace spillway::formats::laz {
namespace {

template <Keep kKeep>
std::unique_ptr<Point10Item> make_point(const LazItem& item) {
  if (item.type != LazItemType::kPoint10)
    throw Failure("the compressed record begins with no point");
  if (item.version == 1) return std::make_unique<Point10V1<kKeep>>();
  return std::make_unique<Point10V2<kKeep>>();
}

template <Keep kKeep>
std::unique_ptr<PointwiseItem> make_item(const LazItem& item) {
  const bool first_version = item.version == 1;
  switch (item.type) {
    case LazItemType::kGpsTime11:
      if (first_version) return std::make_unique<GpsTime11V1<kKeep>>();
      return std::make_unique<GpsTime11V2<kKeep>>();
    case LazItemType::kRgb12:
      if (first_version) return std::make_unique<Rgb12V1<kKeep>>();
      return std::make_unique<Rgb12V2<kKeep>>();
    case LazItemType::kWavePacket13:
      return std::make_unique<WavePacket13<kKeep>>();
    case LazItemType::kByte:
      if (first_version) return std::make_unique<ByteV1<kKeep>>(item.size);
      return std::make_unique<ByteV2<kKeep>>(item.size);
    default:
      throw Failure("the compressed record has a part that does not belong there");
  }
}

}  // namespace

PointwiseChunk::PointwiseChunk(const LazChunkFormat& format, LazDetail detail) {
  const bool whole = detail == LazDetail::kRecords;
  std::size_t at = 0;
  for (const LazItem& item : format.items) {
    if (at == 0) {
      point_ = whole ? make_point<Keep::kWhole>(item) : make_point<Keep::kNeeded>(item);
    } else {
      others_.push_back(
          {whole ? make_item<Keep::kWhole>(item) : make_item<Keep::kNeeded>(item), at});
    }
    at += item.size;
  }
  record_.resize(at);
}

void PointwiseChunk::begin(LazBytes& bytes, std::uint64_t /*count*/) {
  ChunkInput input(bytes);
  std::vector<std::byte> gathered;
  std::ranges::copy(input.take(record_.size(), gathered), record_.begin());
  point_->reset(record_.data());
  for (const Item& item : others_) item.models->reset(&record_[item.at]);
  at_first_ = true;
  stream_ = ArithmeticDecoder(input.rest(), &bytes);
}

void PointwiseChunk::decode(std::span<LatticePoint> points, std::span<LasFlags> attributes) {
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (!at_first_) {
      point_->decode(stream_, nullptr);
      for (const Item& item : others_) item.models->decode(stream_, nullptr);
    }
    at_first_ = false;
    const Point10& point = point_->point();
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

void PointwiseChunk::decode_records(std::span<std::byte> records) {
  for (; !records.empty(); records = records.subspan(record_.size())) {
    if (!at_first_) {
      point_->decode(stream_, record_.data());
      for (const Item& item : others_) item.models->decode(stream_, record_.data() + item.at);
    }
    at_first_ = false;
    std::ranges::copy(record_, records.begin());
  }
}

}  // namespace spillway::formats::laz
