#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "formats/bytes/input_bytes.h"
#include "formats/points/laz/coding/laz_bytes.h"

namespace spillway::formats {

/// The bytes of a stream that is read front to back, in spans.
class FileBytes : public LazBytes {
 public:
  /// `source` must outlive it and be read by nobody else while spans are taken.
  explicit FileBytes(InputBytes& source) : source_(source) {}

  /// The spans end after that many bytes.
  void limit(std::uint64_t bytes) { left_ = bytes; }

  std::span<const std::byte> more() override;

  /// Gives back the last `count` bytes of the last span.
  void put_back(std::size_t count) {
    put_back_ = count;
    left_ += count;
  }

  /// Bytes that may still be taken.
  [[nodiscard]] std::uint64_t left() const { return left_; }
  /// Number of the next byte in the file.
  [[nodiscard]] std::uint64_t position() const { return source_.position() - put_back_; }
  /// Whether all bytes have been taken that there are, or may be.
  [[nodiscard]] bool at_end();
  /// Whether an Failure came from the source and not from what the bytes say.
  [[nodiscard]] bool read_failed() const { return reading_; }

 private:
  static constexpr std::size_t kBufferSize = std::size_t{1} << 18;

  InputBytes& source_;
  std::vector<std::byte> buffer_;
  std::size_t put_back_ = 0;  // at the end of buffer_
  std::uint64_t left_ = 0;
  bool reading_ = false;
};

}  // namespace spillway::formats
