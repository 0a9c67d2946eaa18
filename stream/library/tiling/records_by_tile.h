#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "formats/disk/scratch_folder.h"

namespace spillway::stream {

/// Records that wait, on the disk beyond some memory, until the file of their tile is written.
/// Tiles have numbers from 0 on.
class RecordsByTile {
 private:
  /// Where some records of a tile are in the file, behind the Batch of those before them.
  struct Batch {
    std::uint64_t offset = 0;
    std::uint64_t bytes = 0;  ///< 0: there are none
  };
  struct Tile {
    Batch spilled;  ///< last
    std::vector<std::byte> latest;
  };

 public:
  /// `name` is that of the scratch file. `scratch` must outlive it.
  RecordsByTile(std::string name, std::uint64_t memory, ScratchFolder& scratch)
      : name_(std::move(name)), memory_(memory), scratch_(scratch) {}

  /// Adds a record of a tile. Throws InvalidArgument for more tiles than there is memory for.
  void add(std::size_t tile, std::span<const std::byte> record);

  /// The tiles that have some, ascending.
  [[nodiscard]] std::vector<std::size_t> tiles() const;

  /// Reads the records of a tile, in the order in which they came.
  class Reader {
   public:
    /// `all` must outlive it, and stay as it is.
    Reader(const RecordsByTile& all, std::size_t tile);

    /// Replaces `bytes` by some whole records; false at the end.
    bool next(std::vector<std::byte>& bytes);

   private:
    const RecordsByTile& all_;
    const Tile& tile_;
    std::vector<Batch> spilled_;  ///< the next one is the last of these
    bool has_latest_ = true;
  };

  [[nodiscard]] std::uint64_t spilled_bytes() const { return file_ ? file_->size() : 0; }

 private:
  void make_tile(std::size_t number);
  void spill();

  const std::string name_;
  const std::uint64_t memory_;
  ScratchFolder& scratch_;
  std::vector<Tile> tiles_;
  std::uint64_t in_memory_ = 0;  ///< bytes
  std::unique_ptr<ScratchFile> file_;
};

}  // namespace spillway::stream
