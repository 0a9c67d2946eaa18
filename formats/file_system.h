#pragma once
// The seam to the disk. Everything that opens, creates, renames or removes a file goes through a
// FileSystem, so that tests can put one in its place that fails, fills up or shortens reads.

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>

namespace spillway {

/// A byte stream that is read forwards, and from any byte on where it is a file.
class InputFile {
 public:
  virtual ~InputFile() = default;

  /// Reads up to buffer.size() bytes; fewer only at the end of the file. Returns how many.
  virtual std::size_t read(std::span<std::byte> buffer) = 0;

  /// Makes the next read() begin at that byte, counted from the first one that could be read.
  /// False, and nothing done, where bytes come only once: a pipe, what is being decompressed.
  virtual bool seek(std::uint64_t /*position*/) { return false; }

  /// Size in bytes; nothing for pipes.
  [[nodiscard]] virtual std::optional<std::uint64_t> size() const = 0;

  /// The name for messages.
  [[nodiscard]] virtual const std::string& name() const = 0;
};

/// A file being written. It gets its final name by commit() and is removed if destroyed without.
class OutputFile {
 public:
  virtual ~OutputFile() = default;

  /// Appends all bytes. Throws Error with the system's reason (disk full, ...), or ClosedPipe.
  virtual void write(std::span<const std::byte> bytes) = 0;

  /// Overwrites bytes that were already written, for headers whose values are known only at the
  /// end. False, and nothing done, if the file cannot go back: a pipe, a terminal, a device.
  virtual bool rewrite(std::uint64_t offset, std::span<const std::byte> bytes) = 0;

  /// Writes what is buffered, closes the file and renames it from NAME.part to NAME. Throws as
  /// write() does.
  virtual void commit() = 0;

  [[nodiscard]] virtual const std::string& name() const = 0;

  /// The path that the file has until commit(), for others that write to it, too; "" if it has
  /// none.
  [[nodiscard]] virtual std::string temporary_path() const { return ""; }
};

/// While it exists, remove_unfinished_files() also removes this file, which another process has
/// created and is going to rename.
class OthersUnfinishedFile {
 public:
  explicit OthersUnfinishedFile(std::string path);
  ~OthersUnfinishedFile();
  OthersUnfinishedFile(const OthersUnfinishedFile&) = delete;
  OthersUnfinishedFile& operator=(const OthersUnfinishedFile&) = delete;

 private:
  std::string path_;
};

class FileSystem {
 public:
  virtual ~FileSystem() = default;

  /// Opens for reading; "-" is standard input. Throws Error for what is missing, not readable or a
  /// folder.
  virtual std::unique_ptr<InputFile> open(const std::string& path) = 0;

  /// Creates NAME.part; "-" is standard output, which has no temporary name, and neither has what
  /// exists and is no regular file (/dev/null, a named pipe): such are written straight to. Where
  /// NAME is a symbolic link, what it points to is replaced, not the link.
  virtual std::unique_ptr<OutputFile> create(const std::string& path) = 0;

  [[nodiscard]] virtual bool exists(const std::string& path) const = 0;
};

/// The machine's own files. A closed pipe is seen as ClosedPipe only where SIGPIPE is ignored,
/// which is main's business.
FileSystem& disk();

/// Makes a private folder in `parent` whose name is `prefix` and six characters, and returns its
/// path. Throws Error with the system's reason, without a hint.
std::string make_temporary_folder(const std::string& parent, const std::string& prefix);

/// Creates an empty file in such a folder. Throws Error likewise.
void create_in_temporary_folder(const std::string& folder, const std::string& name);

/// Whether the folder is there; false also once remove_unfinished_files() has removed it.
bool is_temporary_folder(const std::string& folder);

/// Removes such a folder with all that is in it.
void remove_temporary_folder(const std::string& folder);

/// Removes every file that is still under its temporary name, and the temporary folders with all
/// that is in them. For signal handling: the files' owners must not run on afterwards.
void remove_unfinished_files();

}  // namespace spillway
