#include "formats/points/laz/chunk_encoder.h"

#include <cstdint>
#include <cstring>
#include <utility>
#include <variant>

#include "formats/bytes/bytes.h"
#include "formats/points/laz/encoding/item_encoder.h"
#include "formats/points/laz/encoding/layered_records.h"

namespace spillway::formats {
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

  void add(std::span<const std::byte> records) {
    if (records.empty()) return;
    if (last_.empty()) {
      first_.assign(records.begin(), records.begin() + record_length_);
      for (const Item& item : items_) item.models->reset(first_.data() + item.at);
      last_ = first_;
      records = records.subspan(record_length_);
    }
    const std::byte* last = last_.data();
    for (; !records.empty(); records = records.subspan(record_length_)) {
      for (const Item& item : items_) {
        item.models->encode(stream_, records.data() + item.at, last + item.at);
      }
      last = records.data();
    }
    std::memmove(last_.data(), last, record_length_);
  }

  void finish(std::vector<std::byte>& out) {
    out.insert(out.end(), first_.begin(), first_.end());
    stream_.finish(out);
    last_.clear();
  }

 private:
  struct Item {
    std::size_t at;  // in the record
    std::unique_ptr<laz::ItemEncoder> models;
  };

  std::size_t record_length_;
  std::vector<std::byte> first_;  // record of the chunk
  std::vector<std::byte> last_;   // record so far; empty before the first one
  std::vector<Item> items_;
  laz::ArithmeticEncoder stream_;
};

/// The first record, the number of all, the sizes of the layers, the layers.
class LayeredChunkEncoder {
 public:
  explicit LayeredChunkEncoder(const LazChunkFormat& format)
      : record_length_(record_length_of(format)), layers_(format) {}

  void add(std::span<const std::byte> records) {
    if (records.empty()) return;
    if (count_ == 0) {
      layers_.reset(records.data());
      first_.assign(records.begin(), records.begin() + record_length_);
    }
    const std::size_t encoded = count_ == 0 ? record_length_ : 0;
    for (std::size_t i = encoded; i < records.size(); i += record_length_) {
      layers_.encode(records.data() + i);
    }
    count_ += records.size() / record_length_;
  }

  void finish(std::vector<std::byte>& out) {
    out.insert(out.end(), first_.begin(), first_.end());
    const std::vector<laz::LayerStream*> layers = layers_.layers();
    std::size_t size_at = out.size() + sizeof(std::uint32_t);
    out.resize(size_at + layers.size() * sizeof(std::uint32_t));
    store(&out[size_at - sizeof(std::uint32_t)], static_cast<std::uint32_t>(count_));
    for (laz::LayerStream* layer : layers) {
      const std::size_t before = out.size();
      layer->finish(out, false);
      store(&out[size_at], static_cast<std::uint32_t>(out.size() - before));
      size_at += sizeof(std::uint32_t);
    }
    count_ = 0;
  }

 private:
  std::size_t record_length_;
  std::size_t count_ = 0;         // records so far
  std::vector<std::byte> first_;  // record of the chunk
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
  add(records);
  finish(out);
}

void LazChunkEncoder::add(std::span<const std::byte> records) {
  std::visit([&](auto& chunk) { chunk.add(records); }, impl_->chunk);
}

void LazChunkEncoder::finish(std::vector<std::byte>& out) {
  std::visit([&](auto& chunk) { chunk.finish(out); }, impl_->chunk);
}

}  // namespace spillway::formats
