#pragma once

#include <cstdint>
#include <mutex>
#include <optional>
#include <span>
#include <string>

#include "formats/disk/scratch_folder.h"

namespace spillway::formats {

/// What the scratch files of a folder take on the disk, and took. Safe for many threads.
class ScratchUsage {
 public:
  explicit ScratchUsage(std::optional<std::uint64_t> cap) : cap_(cap) {}

  /// Counts bytes that are about to be written; false, and nothing counted, if they pass the cap.
  bool add(std::uint64_t bytes);
  void remove(std::uint64_t bytes);

  [[nodiscard]] std::uint64_t written() const;
  [[nodiscard]] std::uint64_t peak() const;
  [[nodiscard]] std::optional<std::uint64_t> cap() const { return cap_; }

 private:
  const std::optional<std::uint64_t> cap_;
  mutable std::mutex mutex_;  ///< guards what follows
  std::uint64_t present_ = 0;
  std::uint64_t written_ = 0;
  std::uint64_t peak_ = 0;
};

/// A file that is open for the duration of one operation: there may be more files than descriptors.
class OpenedFile {
 public:
  /// Follows a link to a folder, but none to a file: who may put one there must not choose which.
  OpenedFile(const std::string& path, int flags);
  ~OpenedFile();
  OpenedFile(const OpenedFile&) = delete;
  OpenedFile& operator=(const OpenedFile&) = delete;

  /// -1 if it cannot be opened, with the reason in errno.
  [[nodiscard]] int get() const { return fd_; }

 private:
  int fd_;
};

/// A scratch file at a path. Who derives from it says what becomes of it in the end.
class DiskScratchFile : public ScratchFile {
 public:
  /// Its own bytes are those from `begin` on, `size` of them, which `usage` counts already.
  DiskScratchFile(std::string path, std::uint64_t begin, std::uint64_t size, ScratchUsage& usage)
      : path_(std::move(path)), begin_(begin), size_(size), usage_(usage) {}
  DiskScratchFile(const DiskScratchFile&) = delete;
  DiskScratchFile& operator=(const DiskScratchFile&) = delete;

  void append(std::span<const std::byte> bytes) override;
  void read(std::uint64_t offset, std::span<std::byte> buffer) const override;
  [[nodiscard]] std::uint64_t size() const override { return size_; }
  [[nodiscard]] const std::string& name() const override { return path_; }

 protected:
  [[nodiscard]] std::uint64_t begin() const { return begin_; }

 private:
  std::string path_;
  std::uint64_t begin_;
  std::uint64_t size_;
  ScratchUsage& usage_;
};

/// Throws SystemRefusal: that the system refuses to do this with a scratch file, and what to do.
[[noreturn]] void fail_at_scratch_file(const char* action, const std::string& path, int error);

}  // namespace spillway::formats
