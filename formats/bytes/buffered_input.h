#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>

#include "formats/bytes/input_bytes.h"

namespace spillway::formats {

/// Hands out some bytes at a time of a file that is read a buffer at a time. `source` must outlive
/// it.
class BufferedInput {
 public:
  explicit BufferedInput(InputBytes& source);

  /// The most bytes that take() gives.
  static constexpr std::size_t kLargestRequest = std::size_t{1} << 16;

  /// The next `size` bytes, valid until the next call; null if the file ends before.
  const std::byte* take(std::size_t size) {
    if (end_ - begin_ < size && !refill(size)) return nullptr;
    begin_ += size;
    return buffer_.get() + begin_ - size;
  }

  /// What is in memory of the bytes that come next: some, unless the file ends here. Valid until
  /// the next call.
  std::span<const std::byte> ahead() {
    if (begin_ == end_) refill(1);
    return {buffer_.get() + begin_, end_ - begin_};
  }

  /// Drops bytes; false if the file ends before.
  bool skip(std::uint64_t count);

  /// Number of the next byte.
  [[nodiscard]] std::uint64_t position() const { return source_.position() - (end_ - begin_); }

  /// Number of the byte after the last one, known once take() or skip() has failed.
  [[nodiscard]] std::uint64_t end() const { return source_.position(); }

  /// Bytes of the whole file; nothing for pipes.
  [[nodiscard]] std::optional<std::uint64_t> size() const { return source_.size(); }

  [[nodiscard]] const std::string& name() const { return source_.name(); }

 private:
  static constexpr std::size_t kBufferSize = std::size_t{1} << 20;

  bool refill(std::size_t size);

  InputBytes& source_;
  std::size_t buffer_size_;
  // Not cleared: what is never filled takes no memory.
  std::unique_ptr<std::byte[]> buffer_;
  std::size_t begin_ = 0;  // the bytes not yet given out are [begin_, end_)
  std::size_t end_ = 0;
};

}  // namespace spillway::formats
