#include "formats/points/pcd/lzf_reader.h"

#include <fmt/format.h>

#include <algorithm>

#include "src/error.h"

namespace spillway::formats {

void LzfReader::fail(const char* what) const {
  const std::uint64_t byte = next_ - (held_ - at_);
  throw BadInput(
      source_.name(),
      fmt::format("the compressed points {} at byte {}; get a complete copy", what, byte),
      at_byte(byte));
}

std::uint8_t LzfReader::next_byte() {
  if (at_ == held_) {
    const auto room = static_cast<std::size_t>(std::min<std::uint64_t>(kBuffer, end_ - next_));
    at_ = 0;
    source_.seek(next_);
    held_ = source_.read(std::span(buffer_).first(room));
    next_ += held_;
    if (held_ == 0) fail("end before all that the header says,");
  }
  return static_cast<std::uint8_t>(buffer_[at_++]);
}

void LzfReader::begin_run() {
  constexpr std::uint8_t kFewestBack = 32;
  constexpr std::size_t kLong = 7;
  const std::uint8_t first = next_byte();
  if (first < kFewestBack) {
    left_ = std::size_t{first} + 1;
    back_ = 0;
    return;
  }
  left_ = first >> 5U;
  if (left_ == kLong) left_ += next_byte();
  left_ += 2;
  back_ = ((first & 0x1fU) << 8U) + next_byte() + std::size_t{1};
  if (back_ > made_) fail("are corrupt");
}

void LzfReader::read(std::span<std::byte> bytes) {
  for (std::byte& byte : bytes) {
    if (left_ == 0) begin_run();
    byte = back_ == 0 ? std::byte{next_byte()} : window_[(made_ - back_) % kWindow];
    window_[made_++ % kWindow] = byte;
    --left_;
  }
}

void LzfReader::skip(std::uint64_t bytes) {
  std::array<std::byte, kWindow> dropped;
  while (bytes > 0) {
    const auto part = static_cast<std::size_t>(std::min<std::uint64_t>(dropped.size(), bytes));
    read(std::span(dropped).first(part));
    bytes -= part;
  }
}

}  // namespace spillway::formats
