#include "formats/points/laz/chunk_encoder.h"

#include <cstdint>
#include <utility>
#include <variant>

#include "formats/bytes/bytes.h"
#include "formats/points/laz/encoding/item_encoder.h"
#include "formats/points/laz/encoding/layered_records.h"

namespace spillway::detail {
namespace {

std::size_t record_length_of(const LazChunkFormat& format) {
  std::size_t length = 0;
  for (const LazItem& item : format.items) length += item.size;
  return length;
}

/// The first record as it is, then one stream for all others.
class PointwiseChunkEncoder {
 public:
  explicit PointwiseChunkEncoder(const LazChunkFormat& format)
      : record_length_(record_length_of(format)) {
    std::size_t at = 0;
    for (const LazItem& item : format.items) {
      items_.push_back({at, laz::make_item_encoder(item)});
      at += item.size;
    }
  }

  void encode(std::span<const std::byte> records, std::vector<std::byte>& out) {
    out.insert(out.end(), records.begin(), records.begin() + record_length_);
    for (const Item& item : items_) item.models->reset(records.data() + item.at);
    for (std::size_t i = record_length_; i < records.size(); i += record_length_) {
      const std::byte* record = records.data() + i;
      for (const Item& item : items_) {
        item.models->encode(stream_, record + item.at, record + item.at - record_length_);
      }
    }
    stream_.finish(out);
  }

 private:
  struct Item {
    std::size_t at;  // in the record
    std::unique_ptr<laz::ItemEncoder> models;
  };

  std::size_t record_length_;
  std::vector<Item> items_;
  laz::ArithmeticEncoder stream_;
};

/// The first record, the number of all, the sizes of the layers, the layers.
class LayeredChunkEncoder {
 public:
  explicit LayeredChunkEncoder(const LazChunkFormat& format)
      : record_length_(record_length_of(format)), layers_(format) {}

  void encode(std::span<const std::byte> records, std::vector<std::byte>& out) {
    layers_.reset(records.data());
    for (std::size_t i = record_length_; i < records.size(); i += record_length_) {
      layers_.encode(records.data() + i);
    }
    out.insert(out.end(), records.begin(), records.begin() + record_length_);
    const std::vector<laz::LayerStream*> layers = layers_.layers();
    std::size_t size_at = out.size() + sizeof(std::uint32_t);
    out.resize(size_at + layers.size() * sizeof(std::uint32_t));
    const std::size_t count = records.size() / record_length_;
    store(&out[size_at - sizeof(std::uint32_t)], static_cast<std::uint32_t>(count));
    for (laz::LayerStream* layer : layers) {
      const std::size_t before = out.size();
      layer->finish(out, false);
      store(&out[size_at], static_cast<std::uint32_t>(out.size() - before));
      size_at += sizeof(std::uint32_t);
    }
  }

 private:
  std::size_t record_length_;
  laz::LayeredRecords layers_;
};

}  // namespace

class LazChunkEncoder::Impl {
 public:
  using Chunk = std::variant<PointwiseChunkEncoder, LayeredChunkEncoder>;

  explicit Impl(const LazChunkFormat& format)
      : chunk(format.layered ? Chunk(std::in_place_type<LayeredChunkEncoder>, format)
                             : Chunk(std::in_place_type<PointwiseChunkEncoder>, format)) {}

  Chunk chunk;
};

LazChunkEncoder::LazChunkEncoder(const LazChunkFormat& format)
    : impl_(std::make_unique<Impl>(format)) {}
LazChunkEncoder::~LazChunkEncoder() = default;
LazChunkEncoder::LazChunkEncoder(LazChunkEncoder&&) noexcept = default;
LazChunkEncoder& LazChunkEncoder::operator=(LazChunkEncoder&&) noexcept = default;

void LazChunkEncoder::encode(std::span<const std::byte> records, std::vector<std::byte>& out) {
  std::visit([&](auto& chunk) { chunk.encode(records, out); }, impl_->chunk);
}

}  // namespace spillway::detail
