#pragma once

#include <cstddef>
#include <memory>
#include <string_view>
#include <utility>

#include "formats/disk/file_system.h"

namespace spillway::formats {

/// Collects bytes and hands them to a file in buffers of some megabytes, which the file passes on
/// without copying. Only what is filled of a buffer takes memory, so one that waits takes none.
class BufferedOutput {
 public:
  explicit BufferedOutput(std::unique_ptr<OutputFile> file)
      : file_(std::move(file)), buffer_(std::make_unique_for_overwrite<std::byte[]>(kBufferSize)) {}

  /// The most bytes that reserve() makes room for.
  static constexpr std::size_t kLargestRequest = std::size_t{1} << 16;

  /// Room for `size` bytes, to be filled and then counted by advance().
  std::byte* reserve(std::size_t size) {
    if (kBufferSize - used_ < size) flush();
    return buffer_.get() + used_;
  }

  /// Appends what was put into the room that reserve() gave, up to `end`.
  void advance_to(const std::byte* end) { used_ = end - buffer_.get(); }

  void append(std::string_view text);

  /// Overwrites what was appended before, as OutputFile::rewrite() does.
  bool rewrite(std::uint64_t offset, std::string_view text);

  /// Writes all and gives the file its name.
  void commit();

  [[nodiscard]] const std::string& name() const { return file_->name(); }

 private:
  static constexpr std::size_t kBufferSize = std::size_t{4} << 20;

  void flush();

  std::unique_ptr<OutputFile> file_;
  std::unique_ptr<std::byte[]> buffer_;
  std::size_t used_ = 0;
};

}  // namespace spillway::formats
