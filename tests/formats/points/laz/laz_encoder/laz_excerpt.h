#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "formats/points/common/point_reader.h"
#include "formats/points/laz/chunk_table.h"

namespace spillway::test {

/// Cuts a sound LAZ file into files of one chunk each. Chunks are independent, so what damage does
/// to one shows in such a file as well, and reading it takes a fraction of the time.
class LazExcerpts {
 public:
  explicit LazExcerpts(std::string bytes);

  /// How many excerpts there are; none of files that are not in chunks or have no table.
  [[nodiscard]] std::size_t size() const { return chunks_.size(); }

  [[nodiscard]] const LazChunkFormat& format() const { return las_.laz->format; }

  /// Where the i-th chunk lies in the whole file.
  [[nodiscard]] const LazChunk& chunk(std::size_t i) const { return chunks_[i]; }

  /// The file of the i-th chunk: all before the points, a pointer, the chunk, a table.
  [[nodiscard]] std::string file(std::size_t i) const;

  /// Where chunks begin in such a file.
  [[nodiscard]] std::size_t offset_to_chunk() const { return las_.offset_to_points + 8; }

  /// The points of the i-th chunk among those of the whole file.
  [[nodiscard]] PointBlock points(const PointBlock& whole, std::size_t i) const;

 private:
  std::string bytes_;
  LasHeader las_;
  std::vector<LazChunk> chunks_;
};

}  // namespace spillway::test
