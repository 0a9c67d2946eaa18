#pragma once

#include <cstddef>
#include <memory>
#include <string_view>
#include <utility>
#include <vector>

#include "formats/disk/file_system.h"

namespace spillway::detail {

/// Collects small pieces and hands them to a file in blocks of some megabytes, which the file
/// passes on without copying.
class BlockOutput {
 public:
  explicit BlockOutput(std::unique_ptr<OutputFile> file) : file_(std::move(file)), block_(kBlock) {}

  /// The largest piece that reserve() takes.
  static constexpr std::size_t kLargestPiece = std::size_t{1} << 16;

  /// Room for `size` bytes, to be filled and then counted by advance().
  std::byte* reserve(std::size_t size) {
    if (block_.size() - used_ < size) flush();
    return block_.data() + used_;
  }

  /// Appends what was put into the room that reserve() gave, up to `end`.
  void advance_to(const std::byte* end) { used_ = end - block_.data(); }

  void append(std::string_view text);

  /// Overwrites what was appended before, as OutputFile::rewrite() does.
  bool rewrite(std::uint64_t offset, std::string_view text);

  /// Writes all and gives the file its name.
  void commit();

  [[nodiscard]] const std::string& name() const { return file_->name(); }

 private:
  static constexpr std::size_t kBlock = std::size_t{4} << 20;

  void flush();

  std::unique_ptr<OutputFile> file_;
  std::vector<std::byte> block_;
  std::size_t used_ = 0;
};

}  // namespace spillway::detail
