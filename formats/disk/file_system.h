#pragma once
// The seam to the disk. Everything that opens, creates, renames or removes a file goes through a
// FileSystem, so that tests can put one in its place that fails, fills up or shortens reads.

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <stop_token>
#include <string>

#include "src/rooms.h"

namespace spillway::formats {

/// A byte stream that is read forwards, and from any byte on where it is a file.
class InputFile {
 public:
  virtual ~InputFile() = default;

  /// Reads up to buffer.size() bytes; fewer only at the end of the file. Returns how many.
  virtual std::size_t read(std::span<std::byte> buffer) = 0;

  /// Makes the next read() begin at that byte, counted from the first one that could be read.
  /// False, and nothing done, where bytes come only once: a pipe, what is being decompressed.
  virtual bool seek(std::uint64_t /*position*/) { return false; }

  /// Reads from that byte on as read() does, which it leaves alone; several threads may at a time.
  /// Nothing where that is not possible: where bytes come only once.
  virtual std::optional<std::size_t> read_at(std::uint64_t /*position*/,
                                             std::span<std::byte> /*buffer*/) const {
    return std::nullopt;
  }

  /// Size in bytes; nothing for pipes.
  [[nodiscard]] virtual std::optional<std::uint64_t> size() const = 0;

  /// The name for messages.
  [[nodiscard]] virtual const std::string& name() const = 0;
};

/// A file being written. It gets its final name by commit() and is removed if destroyed without.
class OutputFile {
 public:
  virtual ~OutputFile() = default;

  /// Appends all bytes. Throws Failure with the system's reason (disk full, ...), or ClosedPipe.
  virtual void write(std::span<const std::byte> bytes) = 0;

  /// Overwrites bytes that were already written, for headers whose values are known only at the
  /// end. False, and nothing done, if the file cannot go back: a pipe, a terminal, a device.
  virtual bool rewrite(std::uint64_t offset, std::span<const std::byte> bytes) = 0;

  /// Brings everything so far to the disk itself, and returns how many bytes that are. Throws as
  /// write() does.
  virtual std::uint64_t sync();

  /// Goes on after that many bytes, which a process before this one has brought to the disk, and
  /// which this one may have written again. Only of what keep_outputs() creates. Throws BadInput if
  /// there are fewer.
  virtual void go_on_after(std::uint64_t bytes);

  /// Writes what is buffered, closes the file and gives it its name. Throws as write() does.
  virtual void commit() = 0;

  [[nodiscard]] virtual const std::string& name() const = 0;

  /// The path that the file has until commit(), for others that write to it, too; "" if it has
  /// none.
  [[nodiscard]] virtual std::string temporary_path() const { return ""; }
};

class FileSystem {
 public:
  virtual ~FileSystem() = default;

  /// Opens for reading; "-" is standard input. Throws Failure for what is missing, not readable or a
  /// folder, and for a standard input that is closed.
  virtual std::unique_ptr<InputFile> open(const std::string& path) = 0;

  /// Creates NAME.XXXXXX.part (unfinished_files.h), with the permissions of the file that it is
  /// going to replace; "-" is standard output, which has no temporary name, and neither has what
  /// exists and is no regular file (/dev/null, a named pipe): such are written straight to. Where
  /// NAME is a symbolic link, what it points to is replaced or created, not the link.
  virtual std::unique_ptr<OutputFile> create(const std::string& path) = 0;

  [[nodiscard]] virtual bool exists(const std::string& path) const = 0;
};

/// The machine's own files. A closed pipe is seen as ClosedPipe only where SIGPIPE is ignored,
/// which is main's business.
FileSystem& disk();

/// The same, but outputs are called NAME.MARK.part until commit(), and stay there if they are
/// destroyed or the process ends before, however it does. Such a file that is there is opened as it
/// is, and what is written takes the place of what it holds. `mark` is of six characters. Throws
/// InvalidArgument for outputs that are no regular files.
std::unique_ptr<FileSystem> keep_outputs(std::string mark);

/// The same; reading a pipe throws Interrupted when `stop` is requested while it waits for a
/// writer.
std::unique_ptr<FileSystem> disk_until(std::stop_token stop);

}  // namespace spillway::formats
