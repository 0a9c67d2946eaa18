#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "formats/bytes/input_bytes.h"

namespace spillway::formats {

/// Decompresses LZF, as much at a time as is asked for. A copy goes on by itself from where the
/// original is, so that several may read parts of one stream side by side. Source: M. Lehmann,
/// LibLZF: a byte below 32 is followed by so many and one more bytes as they are; else its upper
/// three bits tell a length, 7 with another byte more, and its lower five with the byte after that
/// how far back so many and two more bytes stand.
class LzfReader {
 public:
  /// Of the compressed bytes [begin, end) of a file that can seek, and must outlive the reader.
  LzfReader(InputBytes& source, std::uint64_t begin, std::uint64_t end)
      : source_(source), next_(begin), end_(end) {}

  /// Fills `bytes`. Throws BadInput for what is no LZF, and if there are not so many.
  void read(std::span<std::byte> bytes);
  /// Passes over bytes.
  void skip(std::uint64_t bytes);

  /// Whether all compressed bytes have been used up.
  [[nodiscard]] bool at_end() const { return next_ == end_ && at_ == held_ && left_ == 0; }

 private:
  static constexpr std::size_t kWindow = 8192;  // as far as LZF looks back
  static constexpr std::size_t kBuffer = 16384;

  std::uint8_t next_byte();
  void begin_run();
  [[noreturn]] void fail(const char* what) const;

  InputBytes& source_;
  std::uint64_t next_;  // byte of the file that comes into the buffer next
  std::uint64_t end_;
  std::array<std::byte, kBuffer> buffer_{};  // [at_, held_) is still to be used
  std::size_t at_ = 0;
  std::size_t held_ = 0;
  std::array<std::byte, kWindow> window_{};  // the last bytes that were made, in a ring
  std::uint64_t made_ = 0;
  std::size_t left_ = 0;  // bytes of the run that are still to come
  std::size_t back_ = 0;  // how far back they stand; 0: they are in the input
};

}  // namespace spillway::formats
