#include "formats/points/las/laz_record.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <vector>

#include "formats/bytes/bytes.h"
#include "formats/points/las/las_header.h"
#include "src/error.h"

namespace spillway::formats {
namespace {

constexpr std::size_t kRecordSize = 34;
constexpr std::size_t kItemSize = 6;
constexpr std::uint32_t kVariableChunks = 0xFFFFFFFF;

/// Size in a record (0: any) and the versions of an item.
struct ItemKind {
  LazItemType type;
  std::uint16_t size;
  std::uint16_t least_version;
  std::uint16_t most_version;
  std::uint16_t layers;  // 0: one for each byte
};

constexpr std::array<ItemKind, 10> kItemKinds = {{{LazItemType::kByte, 0, 1, 2, 0},
                                                  {LazItemType::kPoint10, 20, 1, 2, 0},
                                                  {LazItemType::kGpsTime11, 8, 1, 2, 0},
                                                  {LazItemType::kRgb12, 6, 1, 2, 0},
                                                  {LazItemType::kWavePacket13, 29, 1, 1, 0},
                                                  {LazItemType::kPoint14, 30, 2, 4, 9},
                                                  {LazItemType::kRgb14, 6, 2, 4, 1},
                                                  {LazItemType::kRgbNir14, 8, 2, 4, 2},
                                                  {LazItemType::kWavePacket14, 29, 3, 4, 1},
                                                  {LazItemType::kByte14, 0, 2, 4, 0}}};

const ItemKind& kind_of(LazItemType type) {
  return *std::find_if(kItemKinds.begin(), kItemKinds.end(),
                       [&](const ItemKind& kind) { return kind.type == type; });
}

/// The items that records of a point format are made of, extra bytes last.
std::vector<LazItemType> items_of(int point_format, bool extra_bytes) {
  const auto is_one_of = [&](std::initializer_list<int> formats) {
    return std::find(formats.begin(), formats.end(), point_format) != formats.end();
  };
  const bool layered = point_format >= 6;
  std::vector<LazItemType> items = {layered ? LazItemType::kPoint14 : LazItemType::kPoint10};
  if (is_one_of({1, 3, 4, 5})) items.push_back(LazItemType::kGpsTime11);
  if (is_one_of({2, 3, 5})) items.push_back(LazItemType::kRgb12);
  if (is_one_of({4, 5})) items.push_back(LazItemType::kWavePacket13);
  if (is_one_of({7})) items.push_back(LazItemType::kRgb14);
  if (is_one_of({8, 10})) items.push_back(LazItemType::kRgbNir14);
  if (is_one_of({9, 10})) items.push_back(LazItemType::kWavePacket14);
  if (extra_bytes) items.push_back(layered ? LazItemType::kByte14 : LazItemType::kByte);
  return items;
}

}  // namespace

LazRecord parse_laz_record(std::span<const std::byte> content, int point_format,
                           std::size_t record_length, const FileSpot& where) {
  const auto fail = [&](const std::string& what) {
    throw BadInput(where.file, fmt::format("the LAZ record {}", what), where.place);
  };
  if (content.size() < kRecordSize) {
    fail(fmt::format("has {} bytes, but {} are needed; the file is corrupt", content.size(),
                     kRecordSize));
  }
  const auto compressor = load<std::uint16_t>(content.data());
  const auto coder = load<std::uint16_t>(&content[2]);
  const auto chunk_points = load<std::uint32_t>(&content[12]);
  const std::size_t items = load<std::uint16_t>(&content[32]);
  if (compressor > 3 || coder != 0) {
    fail(
        fmt::format("names compressor {} and coder {}, which are not known; the file is corrupt "
                    "or newer than this program",
                    compressor, coder));
  }
  LazRecord record;
  record.compressor = static_cast<LazCompressor>(compressor);
  if (record.compressor == LazCompressor::kNone) return record;
  if (chunk_points != 0 && chunk_points != kVariableChunks) record.chunk_points = chunk_points;
  record.format.layered = record.compressor == LazCompressor::kLayeredChunked;
  if (record.format.layered != (point_format >= 6)) {
    fail(
        fmt::format("names compressor {}, which point format {} does not go with; the file is "
                    "corrupt",
                    compressor, point_format));
  }

  const std::size_t extra_bytes = record_length - kLasRecordLengths.at(point_format);
  const std::vector<LazItemType> expected = items_of(point_format, extra_bytes > 0);
  if (items != expected.size() || content.size() < kRecordSize + items * kItemSize) {
    fail(
        fmt::format("lists {} items in {} bytes, but point format {} with {} extra bytes has {}; "
                    "the file is corrupt",
                    items, content.size(), point_format, extra_bytes, expected.size()));
  }
  for (std::size_t i = 0; i < items; ++i) {
    const std::byte* bytes = &content[kRecordSize + i * kItemSize];
    const auto type = load<std::uint16_t>(bytes);
    const LazItem item{expected[i], load<std::uint16_t>(bytes + 2), load<std::uint16_t>(bytes + 4)};
    const ItemKind& kind = kind_of(item.type);
    const std::size_t size = kind.size > 0 ? kind.size : extra_bytes;
    if (type != static_cast<std::uint16_t>(item.type) || item.size != size) {
      fail(fmt::format(
          "has {} bytes of type {} as item {}, but point format {} needs {} of type "
          "{}; the file is corrupt",
          item.size, type, i, point_format, size, static_cast<std::uint16_t>(item.type)));
    }
    if (item.version < kind.least_version || item.version > kind.most_version) {
      fail(
          fmt::format("has version {} of item {}, but only {} to {} are known; the file is corrupt "
                      "or newer than this program",
                      item.version, i, kind.least_version, kind.most_version));
    }
    record.format.items.push_back(item);
  }
  return record;
}

LazChunkFormat laz_format_to_write(int point_format, std::size_t extra_bytes) {
  LazChunkFormat format;
  format.layered = point_format >= 6;
  for (const LazItemType type : items_of(point_format, extra_bytes > 0)) {
    const ItemKind& kind = kind_of(type);
    const std::uint16_t version =
        format.layered ? 3 : std::min<std::uint16_t>(2, kind.most_version);
    const std::size_t size = kind.size > 0 ? kind.size : extra_bytes;
    format.items.push_back({type, static_cast<std::uint16_t>(size), version});
  }
  return format;
}

std::vector<std::byte> laz_record_bytes(const LazRecord& record) {
  // The version of the format that is written, as LASzip counts.
  constexpr std::uint8_t kMajor = 3;
  constexpr std::uint8_t kMinor = 4;
  constexpr std::int64_t kUnused = -1;
  const std::vector<LazItem>& items = record.format.items;
  std::vector<std::byte> bytes(kRecordSize + items.size() * kItemSize);
  store(bytes.data(), static_cast<std::uint16_t>(record.compressor));
  store(&bytes[4], kMajor);
  store(&bytes[5], kMinor);
  store(&bytes[12], record.chunk_points.value_or(kVariableChunks));
  store(&bytes[16], kUnused);
  store(&bytes[24], kUnused);
  store(&bytes[32], static_cast<std::uint16_t>(items.size()));
  std::byte* at = &bytes[kRecordSize];
  for (const LazItem& item : items) {
    store(at, static_cast<std::uint16_t>(item.type));
    store(at + 2, item.size);
    store(at + 4, item.version);
    at += kItemSize;
  }
  return bytes;
}

std::size_t laz_layers(const LazItem& item) {
  const std::uint16_t fixed = kind_of(item.type).layers;
  return fixed > 0 ? fixed : item.size;
}

std::size_t laz_layers(const LazChunkFormat& format) {
  std::size_t layers = 0;
  for (const LazItem& item : format.items) layers += laz_layers(item);
  return layers;
}

}  // namespace spillway::formats
