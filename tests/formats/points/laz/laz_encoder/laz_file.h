#pragma once
// LAZ files for tests, made from records. What such a file says of itself lies open, so that tests
// of damaged files can make it say something else.

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "tests/formats/points/las/las_file.h"
#include "tests/formats/points/laz/laz_encoder/chunk_encoder.h"

namespace spillway::test {

/// How records are to be compressed.
struct LazFormat {
  int point_format = 0;
  std::size_t extra_bytes = 0;
  int compressor = 2;  ///< 0 none, 1 one pointwise chunk, 2 pointwise chunks, 3 layered chunks
  int version = 2;     ///< of all items, or what comes nearest
  /// Points of each chunk: sizes are variable; if empty all chunks have `chunk_size`.
  std::vector<std::uint32_t> counts{};
  std::uint32_t chunk_size = 50000;
  LazChunkOptions chunk{};
};

struct LazFile {
  struct Chunk {
    std::uint32_t count;
    std::string bytes;
  };
  struct TableEntry {
    std::uint32_t count;
    std::uint32_t bytes;
  };
  enum class Table { kSeekable, kStreamed, kMissing };

  LasFile las;                     ///< header and other VLRs; its records are not written
  std::uint8_t compressed = 0x80;  ///< flag in the point format
  int laz_records = 1;             ///< how many LAZ VLRs
  std::uint16_t compressor = 2;
  std::uint16_t coder = 0;
  std::uint32_t chunk_size = 0;
  std::vector<LazItem> items;
  std::uint64_t count = 0;  ///< of points, as the header says
  std::vector<Chunk> chunks;
  std::vector<TableEntry> table;
  std::uint32_t table_version = 0;
  Table table_place = Table::kSeekable;
  std::vector<LasFile::Vlr> evlrs;  ///< behind the table; only LAS 1.4 has them

  static constexpr std::uint32_t kVariable = 0xffffffff;

  [[nodiscard]] std::size_t offset_to_points() const;
  [[nodiscard]] std::size_t offset_to_chunk(std::size_t i) const;
  /// Where the table is, or would be.
  [[nodiscard]] std::size_t offset_to_table() const { return offset_to_chunk(chunks.size()); }
  [[nodiscard]] std::string bytes() const;

 private:
  [[nodiscard]] bool has_pointer() const { return compressor >= 2; }
  [[nodiscard]] LasFile header() const;
  [[nodiscard]] std::string laz_record() const;
  [[nodiscard]] std::string evlr_bytes() const;
};

/// The items of a point format, as encoders list them.
std::vector<LazItem> laz_items(int point_format, std::size_t extra_bytes, int version);

/// A chunk table; numbers of points are stored only where chunks have different ones.
std::string laz_table_bytes(std::span<const LazFile::TableEntry> table, bool with_counts,
                            std::uint32_t version = 0);

/// The records in chunks, with the lowest LAS version (from 1.2) that has the point format.
LazFile make_laz_file(const LazFormat& format, std::span<const std::string> records);

}  // namespace spillway::test
