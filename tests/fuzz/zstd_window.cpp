#include "tests/fuzz/zstd_window.h"

#include <array>
#include <cstddef>
#include <cstdint>

namespace spillway::test {
namespace {

constexpr std::string_view kMagic = "\x28\xb5\x2f\xfd";
constexpr std::uint64_t kLargeWindow = std::uint64_t{128} << 20;

/// The window of a frame without its magic; 0 if the header is not whole.
std::uint64_t window_of(std::string_view header) {
  constexpr std::array<std::size_t, 4> kIdSizes = {0, 1, 2, 4};
  const auto byte = [&](std::size_t i) {
    return i < header.size() ? static_cast<unsigned char>(header[i]) : std::uint64_t{0};
  };
  const std::uint64_t descriptor = byte(0);
  const bool tells_content_alone = (descriptor >> 5 & 1) != 0;
  if (!tells_content_alone) {
    const std::uint64_t power = std::uint64_t{1} << (10 + (byte(1) >> 3));
    return power + power / 8 * (byte(1) & 7);
  }
  const std::size_t size = std::size_t{1} << (descriptor >> 6);
  std::uint64_t content = 0;
  for (std::size_t i = 0; i < size; ++i) {
    content |= byte(1 + kIdSizes.at(descriptor & 3) + i) << (8 * i);
  }
  return content;
}

}  // namespace

bool has_large_zstd_window(std::string_view bytes) {
  for (std::size_t at = bytes.find(kMagic); at != bytes.npos; at = bytes.find(kMagic, at + 1)) {
    if (window_of(bytes.substr(at + kMagic.size())) > kLargeWindow) return true;
  }
  return false;
}

}  // namespace spillway::test
