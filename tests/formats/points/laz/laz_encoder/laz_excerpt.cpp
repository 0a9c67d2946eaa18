#include "tests/formats/points/laz/laz_encoder/laz_excerpt.h"

#include <utility>

#include "tests/faulty_file_system.h"
#include "tests/formats/points/laz/laz_encoder/laz_file.h"

namespace spillway::test {

LazExcerpts::LazExcerpts(std::string bytes) : bytes_(std::move(bytes)) {
  FaultyFileSystem files;
  files.files["whole.laz"] = bytes_;
  InputBytes source(files.open("whole.laz"));
  las_ = read_las_header(source);
  if (las_.laz && las_.laz->compressor != LazCompressor::kPointwise) {
    chunks_ = read_chunk_table(source, las_).value_or(LazChunkTable()).chunks;
  }
}

std::string LazExcerpts::file(std::size_t i) const {
  const LazChunk& chunk = chunks_[i];
  std::string file = bytes_.substr(0, las_.offset_to_points);
  std::uint32_t legacy_count = 0;
  std::memcpy(&legacy_count, &file[107], sizeof(legacy_count));
  if (legacy_count > 0) put(file, 107, static_cast<std::uint32_t>(chunk.count));
  if (file[25] >= 4) {
    put(file, 243, std::uint32_t{0});  // extended records
    put(file, 247, chunk.count);
  }
  if (las_.laz->chunk_points) {
    // A chunk that is not full is the last one: without a table, too, it must end with the room.
    const std::size_t laz_record = file.find(kLazUser) - 2 + kLasVlrHeaderSize;
    put(file, laz_record + 12, static_cast<std::uint32_t>(chunk.count + 1));
  }
  file += bytes_of(std::uint64_t{las_.offset_to_points + 8 + chunk.bytes});
  file += bytes_.substr(chunk.offset, chunk.bytes);
  const LazFile::TableEntry entry{static_cast<std::uint32_t>(chunk.count),
                                  static_cast<std::uint32_t>(chunk.bytes)};
  return file + laz_table_bytes({&entry, 1}, !las_.laz->chunk_points);
}

PointBlock LazExcerpts::points(const PointBlock& whole, std::size_t i) const {
  std::uint64_t first = 0;
  for (std::size_t before = 0; before < i; ++before) first += chunks_[before].count;
  const auto part_of = [&](const auto& values) {
    const auto begin = values.begin() + static_cast<std::ptrdiff_t>(first);
    return std::vector(begin, begin + static_cast<std::ptrdiff_t>(chunks_[i].count));
  };
  PointBlock part;
  part.points = part_of(whole.points);
  part.index = part_of(whole.index);
  const std::size_t record = whole.record_size();
  const std::byte* const attributes = whole.attributes.data() + first * record;
  part.attributes.assign(attributes, attributes + chunks_[i].count * record);
  return part;
}

}  // namespace spillway::test
