#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "formats/disk/file_system.h"

namespace spillway::formats {

/// An input file whose next bytes can be looked at before they are read, so that a pipe's format
/// can be recognised, and that knows how far it has been read.
class InputBytes : public InputFile {
 public:
  explicit InputBytes(std::unique_ptr<InputFile> file) : file_(std::move(file)) {}

  /// The next `count` bytes, fewer at the end of the file; unread still. Valid until the next call.
  std::span<const std::byte> peek(std::size_t count);

  /// Throws Failure if there is nothing to read.
  void check_not_empty();

  std::size_t read(std::span<std::byte> buffer) override;

  bool seek(std::uint64_t position) override;

  std::optional<std::size_t> read_at(std::uint64_t position,
                                     std::span<std::byte> buffer) const override {
    return file_->read_at(position, buffer);
  }

  /// Whether seek() can go to any byte, and the size is known.
  [[nodiscard]] bool seekable() { return size() && seek(position_); }

  /// Reads and drops bytes; false if the file ends before.
  bool skip(std::uint64_t count);

  [[nodiscard]] std::optional<std::uint64_t> size() const override { return file_->size(); }
  [[nodiscard]] const std::string& name() const override { return file_->name(); }

  /// Number of the next byte.
  [[nodiscard]] std::uint64_t position() const { return position_; }

  /// The share of the file that has been read, from 0 to 1; nothing for pipes.
  [[nodiscard]] std::optional<double> fraction_read() const;

 private:
  std::unique_ptr<InputFile> file_;
  std::vector<std::byte> peeked_;
  std::size_t peeked_read_ = 0;  // bytes of peeked_ that read() has given out
  std::uint64_t position_ = 0;
};

}  // namespace spillway::formats
