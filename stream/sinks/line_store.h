#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "formats/disk/scratch_folder.h"
#include "src/geometry/point.h"
#include "src/runtime/packing.h"

namespace spillway::stream {

/// Whole lines of contours that wait on the disk until they are asked for.
class LineStore {
 public:
  /// `scratch` must outlive it.
  explicit LineStore(ScratchFolder& scratch) : scratch_(scratch) {}

  void add(std::span<const Point<2>> points, std::int64_t level);

  /// Some lines as bytes, at least one; nothing when all have been had.
  std::vector<std::byte> take();

  [[nodiscard]] std::uint64_t stored_bytes() const { return file_ ? file_->size() : 0; }

  /// Adds a line to such bytes.
  static void put(Packer& lines, std::span<const Point<2>> points, std::int64_t level) {
    lines.put(level);
    lines.put_list(points);
  }

  /// Calls take(points, level) with each line of such bytes.
  template <typename Take>
  static void for_each(std::span<const std::byte> bytes, const Take& take) {
    for (Unpacker lines(bytes); !lines.empty();) {
      const auto level = lines.take<std::int64_t>();
      take(lines.take_list<std::vector<Point<2>>>(), level);
    }
  }

 private:
  struct Batch {
    std::uint64_t offset = 0;
    std::size_t bytes = 0;
  };

  ScratchFolder& scratch_;
  std::unique_ptr<ScratchFile> file_;
  std::vector<Batch> batches_;  ///< in the file
  std::size_t next_ = 0;        ///< of these
  Packer last_;                 ///< what is not in the file
};

}  // namespace spillway::stream
