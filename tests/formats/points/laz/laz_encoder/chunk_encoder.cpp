#include "tests/formats/points/laz/laz_encoder/chunk_encoder.h"

#include <algorithm>
#include <cstddef>
#include <memory>

#include "formats/bytes/bytes.h"
#include "formats/points/laz/chunk_encoder.h"
#include "formats/points/laz/encoding/layered_records.h"
#include "tests/formats/point_test_helpers.h"
#include "tests/formats/points/laz/laz_encoder/fields.h"
#include "tests/formats/points/laz/laz_encoder/items_v1_encoder.h"

namespace spillway::test {
namespace {

const std::byte* bytes_at(const std::string& record, std::size_t at) {
  return as_bytes_of(record).data() + at;
}

std::string text_of(std::span<const std::byte> bytes) { return std::string(as_text(bytes)); }

std::string encode_pointwise(const std::vector<LazItem>& items,
                             std::span<const std::string> records) {
  struct ItemCoder {
    std::size_t at;
    std::unique_ptr<laz::ItemEncoder> models;
  };
  std::vector<ItemCoder> coders;
  std::size_t at = 0;
  for (const LazItem& item : items) {
    coders.push_back({at, make_any_item_encoder(item)});
    coders.back().models->reset(bytes_at(records.front(), at));
    at += item.size;
  }
  laz::ArithmeticEncoder stream;
  for (std::size_t i = 1; i < records.size(); ++i) {
    for (const ItemCoder& coder : coders) {
      coder.models->encode(stream, bytes_at(records[i], coder.at),
                           bytes_at(records[i - 1], coder.at));
    }
  }
  std::vector<std::byte> bytes;
  stream.finish(bytes);
  return records.front() + text_of(bytes);
}

std::string encode_layered(const LazChunkFormat& format, std::span<const std::string> records,
                           const LazChunkOptions& options) {
  const std::string& first = records.front();
  laz::LayeredRecords chunk(format);
  chunk.reset(bytes_at(first, 0));
  bool z_changes = false;
  for (const std::string& record : records.subspan(1)) {
    chunk.encode(bytes_at(record, 0));
    z_changes |= record.substr(kZ, 4) != first.substr(kZ, 4);
  }
  const std::vector<laz::LayerStream*> layers = chunk.layers();
  if (options.empty_z_layer) layers[laz::Point14Encoder::kZLayer]->changes = z_changes;

  std::string sizes;
  std::vector<std::byte> bytes;
  for (laz::LayerStream* layer : layers) {
    const std::size_t before = bytes.size();
    layer->finish(bytes, options.all_layers);
    sizes += bytes_of(static_cast<std::uint32_t>(bytes.size() - before));
  }
  return first + bytes_of(static_cast<std::uint32_t>(records.size())) + sizes + text_of(bytes);
}

/// As Spillway writes it.
std::string encode_as_written(const LazChunkFormat& format, std::span<const std::string> records) {
  std::string all;
  for (const std::string& record : records) all += record;
  std::vector<std::byte> bytes;
  LazChunkEncoder(format).encode(as_bytes_of(all), bytes);
  return text_of(bytes);
}

}  // namespace

std::string encode_laz_chunk(const std::vector<LazItem>& items,
                             std::span<const std::string> records, const LazChunkOptions& options) {
  const bool layered = items.front().type == LazItemType::kPoint14;
  const bool has_version1 = std::ranges::any_of(items, [](const LazItem& item) {
    return item.version == 1 && item.type != LazItemType::kWavePacket13;
  });
  const LazChunkFormat format{.items = items, .layered = layered};
  const bool as_written = !options.all_layers && !options.empty_z_layer;
  if (has_version1) return encode_pointwise(items, records);
  if (layered && !as_written) return encode_layered(format, records, options);
  return encode_as_written(format, records);
}

}  // namespace spillway::test
