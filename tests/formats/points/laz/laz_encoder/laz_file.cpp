#include "tests/formats/points/laz/laz_encoder/laz_file.h"

#include <algorithm>
#include <numeric>

#include "formats/bytes/bytes.h"
#include "formats/points/laz/chunk_table_bytes.h"

namespace spillway::test {

std::vector<LazItem> laz_items(int point_format, std::size_t extra_bytes, int version) {
  const auto items_version = static_cast<std::uint16_t>(version);
  // Wave packets have neither version 2.
  const auto wave13_version = static_cast<std::uint16_t>(std::min(version, 1));
  const auto wave14_version = static_cast<std::uint16_t>(version == 2 ? 3 : version);
  const auto extra = static_cast<std::uint16_t>(extra_bytes);
  const LazItem gps{LazItemType::kGpsTime11, 8, items_version};
  const LazItem rgb{LazItemType::kRgb12, 6, items_version};
  const LazItem rgb_nir{LazItemType::kRgbNir14, 8, items_version};
  std::vector<LazItem> items;
  if (point_format < 6) {
    const bool wave = point_format >= 4;
    items.push_back({LazItemType::kPoint10, 20, items_version});
    if (point_format == 1 || point_format >= 3) items.push_back(gps);
    if (point_format == 2 || point_format == 3 || point_format == 5) items.push_back(rgb);
    if (wave) items.push_back({LazItemType::kWavePacket13, 29, wave13_version});
    if (extra > 0) items.push_back({LazItemType::kByte, extra, items_version});
    return items;
  }
  items.push_back({LazItemType::kPoint14, 30, items_version});
  if (point_format == 7) items.push_back({LazItemType::kRgb14, 6, items_version});
  if (point_format == 8 || point_format == 10) items.push_back(rgb_nir);
  if (point_format >= 9) items.push_back({LazItemType::kWavePacket14, 29, wave14_version});
  if (extra > 0) items.push_back({LazItemType::kByte14, extra, items_version});
  return items;
}

std::string laz_table_bytes(std::span<const LazFile::TableEntry> table, bool with_counts,
                            std::uint32_t version) {
  std::vector<LazChunk> chunks;
  for (const LazFile::TableEntry& entry : table) {
    chunks.push_back({.bytes = entry.bytes, .count = entry.count});
  }
  std::string bytes(as_text(chunk_table_bytes(chunks, with_counts)));
  put(bytes, 0, version);
  return bytes;
}

LazFile make_laz_file(const LazFormat& format, std::span<const std::string> records) {
  LazFile file;
  file.las.point_format = format.point_format;
  file.las.minor = format.point_format < 4 ? 2 : format.point_format < 6 ? 3 : 4;
  file.las.extra_bytes = format.extra_bytes;
  file.compressor = static_cast<std::uint16_t>(format.compressor);
  file.chunk_size = !format.counts.empty() ? LazFile::kVariable : format.chunk_size;
  file.items = laz_items(format.point_format, format.extra_bytes, format.version);
  file.count = records.size();
  if (format.compressor < 2) file.chunk_size = 0;

  std::size_t chunk = 0;
  while (!records.empty()) {
    std::size_t count = records.size();
    if (!format.counts.empty()) count = format.counts.at(chunk++);
    if (file.chunk_size > 0) count = std::min<std::size_t>(count, file.chunk_size);
    const auto part = records.first(count);
    records = records.subspan(count);
    file.chunks.push_back({static_cast<std::uint32_t>(count),
                           format.compressor == 0
                               ? std::accumulate(part.begin(), part.end(), std::string())
                               : encode_laz_chunk(file.items, part, format.chunk)});
    file.table.push_back(
        {file.chunks.back().count, static_cast<std::uint32_t>(file.chunks.back().bytes.size())});
  }
  return file;
}

LasFile LazFile::header() const {
  LasFile header = las;
  header.records.clear();
  for (int i = 0; i < laz_records; ++i) {
    header.vlrs.push_back({"laszip encoded", 22204, laz_record()});
  }
  return header;
}

std::string LazFile::laz_record() const {
  std::string record(34, '\0');
  put(record, 0, compressor);
  put(record, 2, coder);
  put(record, 4, std::uint32_t{0x00010203});
  put(record, 12, chunk_size);
  put(record, 16, std::int64_t{-1});
  put(record, 24, std::int64_t{-1});
  put(record, 32, static_cast<std::uint16_t>(items.size()));
  for (const LazItem& item : items) {
    record += bytes_of(item.type) + bytes_of(item.size) + bytes_of(item.version);
  }
  return record;
}

std::size_t LazFile::offset_to_points() const { return header().offset_to_points(); }

std::size_t LazFile::offset_to_chunk(std::size_t i) const {
  std::size_t offset = offset_to_points() + (has_pointer() ? 8 : 0);
  for (const Chunk& chunk : std::span(chunks).first(i)) offset += chunk.bytes.size();
  return offset;
}

std::string LazFile::evlr_bytes() const {
  std::string bytes;
  for (const LasFile::Vlr& evlr : evlrs) {
    std::string record(60, '\0');
    record.replace(2, evlr.user.size(), evlr.user);
    put(record, 18, evlr.id);
    put(record, 20, std::uint64_t{evlr.content.size()});
    bytes += record + evlr.content;
  }
  return bytes;
}

std::string LazFile::bytes() const {
  std::string file = header().bytes();
  const auto point_format = static_cast<std::uint8_t>(las.point_format | compressed);
  put(file, 104, point_format);
  if (las.point_format < 6) put(file, 107, static_cast<std::uint32_t>(count));
  if (las.minor == 4) put(file, 247, count);

  const std::int64_t table_at = static_cast<std::int64_t>(offset_to_table());
  if (has_pointer()) {
    file += bytes_of(table_place == Table::kSeekable   ? table_at
                     : table_place == Table::kStreamed ? std::int64_t{-1}
                                                       : std::int64_t(offset_to_points()));
  }
  for (const Chunk& chunk : chunks) file += chunk.bytes;
  if (has_pointer() && table_place != Table::kMissing) {
    file += laz_table_bytes(table, chunk_size == kVariable || chunk_size == 0, table_version);
  }
  if (!evlrs.empty()) {
    put(file, 235, std::uint64_t{file.size()});
    put(file, 243, static_cast<std::uint32_t>(evlrs.size()));
    file += evlr_bytes();
  }
  if (has_pointer() && table_place == Table::kStreamed) file += bytes_of(table_at);
  return file;
}

}  // namespace spillway::test
