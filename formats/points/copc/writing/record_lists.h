#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "formats/disk/scratch_folder.h"

namespace spillway::formats {

/// Lists of records of one length, in memory as far as that is allowed, then in a scratch file.
/// Each is appended to, then read once.
class RecordLists {
 public:
  struct Limits {
    std::size_t piece_bytes = std::size_t{1} << 15U;  ///< written to the disk at a time, about
    std::size_t most_in_memory = 0;                   ///< bytes of all full pieces
  };

  /// Without a folder, all stays in memory.
  RecordLists(ScratchFolder* scratch, std::size_t record_length, std::size_t lists,
              const Limits& limits);

  void append(std::size_t list, std::span<const std::byte> records);

  /// Records of a list.
  [[nodiscard]] std::uint64_t count(std::size_t list) const { return lists_[list].count; }
  /// Whether nothing lies on the disk.
  [[nodiscard]] bool in_memory() const { return !file_; }

  /// Gives the next records of a list, as many as there are up to the room for them, and returns
  /// how many bytes that are. Frees the memory of those given. Of different lists also by many
  /// threads, once all is appended.
  std::size_t read(std::size_t list, std::span<std::byte> room);

 private:
  /// In memory, or so many bytes of the scratch file.
  struct Piece {
    std::vector<std::byte> bytes{};
    std::uint64_t offset = 0;
    std::size_t size = 0;
  };
  struct List {
    std::vector<Piece> pieces{};  // the last one may be appended to
    std::uint64_t count = 0;
    std::size_t next = 0;  // piece to be read
    std::size_t done = 0;  // bytes of that which are read
  };

  void complete(Piece& piece);
  void write(Piece& piece);

  ScratchFolder* scratch_;
  std::size_t record_length_;
  std::size_t piece_bytes_;  // whole records
  std::size_t most_in_memory_;
  std::size_t in_memory_ = 0;  // of full pieces
  std::unique_ptr<ScratchFile> file_;
  std::vector<List> lists_;
};

}  // namespace spillway::formats
