#pragma once
// Where a run puts what does not fit into memory.

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>

#include "src/rooms.h"

namespace spillway::formats {

/// A file for one run: appended to, then read. Its bytes are gone from the disk when it is
/// destroyed. append() is called by one thread at a time; read() by any number, also meanwhile, of
/// what has been appended.
class ScratchFile {
 public:
  virtual ~ScratchFile() = default;

  /// Appends all bytes. Throws Failure with the system's reason and what would help (disk full:
  /// another folder; over the cap: a larger one).
  virtual void append(std::span<const std::byte> bytes) = 0;

  /// Fills `buffer` from `offset` on. Throws Failure if the file is shorter.
  virtual void read(std::uint64_t offset, std::span<std::byte> buffer) const = 0;

  [[nodiscard]] virtual std::uint64_t size() const = 0;

  /// The path, for messages.
  [[nodiscard]] virtual const std::string& name() const = 0;
};

/// A private folder, removed with all that is in it: by the destructor, and by
/// remove_unfinished_files() after a signal. Made when the first file is.
class ScratchFolder {
 public:
  virtual ~ScratchFolder() = default;

  /// An empty file whose name begins with `label`: a new one, or one that has been destroyed. May
  /// be called by several threads.
  virtual std::unique_ptr<ScratchFile> create(const std::string& label) = 0;

  /// Bytes appended to all files so far, and the most that lay on the disk at one time.
  [[nodiscard]] virtual std::uint64_t bytes_written() const = 0;
  [[nodiscard]] virtual std::uint64_t peak_bytes() const = 0;
};

/// Where scratch folders are made: `parent`, or, if that is "", $TMPDIR, else /tmp.
std::string scratch_parent(const std::string& parent);

/// A folder of its own in scratch_parent(parent) on the machine's disk, holding at most
/// `cap` bytes at a time.
std::unique_ptr<ScratchFolder> make_scratch_folder(const std::string& parent,
                                                   std::optional<std::uint64_t> cap);

}  // namespace spillway::formats
