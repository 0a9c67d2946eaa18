#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>

#include "formats/bytes/input_bytes.h"
#include "formats/points/common/point_reader.h"
#include "formats/points/rows/row_layout.h"

namespace spillway::formats {

/// Gives rows whose bytes do not just follow one another in the file.
class RowSource {
 public:
  virtual ~RowSource() = default;

  /// Goes to that row, counted from 0. Called only where a file can be read in pieces.
  virtual void go_to(std::uint64_t row) = 0;
  /// Fills `rows`, which has room for whole rows; fewer bytes if the file ends before. Throws Failure
  /// for what is no row.
  virtual std::size_t read(std::span<std::byte> rows) = 0;
  /// Makes sure that nothing is behind the last row that should not be.
  virtual void finish() {}
};

/// A file of rows whose header has been read.
struct RowFile {
  RowLayout row;
  PointHeader header;  ///< name, format, version, count and notices are given; the rest follows
  bool skip_invalid = false;
  std::unique_ptr<InputBytes> source{};  ///< at the first row
  std::unique_ptr<RowSource> rows{};     ///< of the source; null: they follow one another
  /// Whether a row takes row.size() bytes of the file, so that its size can be checked, and rows
  /// can be read from any one on.
  bool has_fixed_size = true;
  /// Whether rows may be none by the format's own rules, and are left out and counted as invalid:
  /// then the header that the reader gives does not promise their number.
  bool has_empty_rows = false;
  /// Bytes after the last row, where sizes are fixed; nothing: unknown.
  std::optional<std::uint64_t> behind = 0;
};

/// Reads points of such a file. Throws Failure if its size is not that of all rows.
std::unique_ptr<PointReader> open_row_reader(RowFile file);

}  // namespace spillway::formats
