#include "formats/bytes/whole_file.h"

#include <algorithm>
#include <limits>

namespace spillway::formats {
namespace {

constexpr std::uint64_t kStep = std::uint64_t{1} << 20;

}  // namespace

std::vector<std::byte> read_whole(InputBytes& source) {
  return read_up_to(source, std::numeric_limits<std::uint64_t>::max());
}

std::vector<std::byte> read_up_to(InputBytes& source, std::uint64_t count) {
  std::vector<std::byte> bytes;
  if (const auto size = source.size()) {
    bytes.reserve(std::min(count, *size - std::min(*size, source.position())));
  }
  while (bytes.size() < count) {
    const std::size_t before = bytes.size();
    const std::size_t step = std::min(kStep, count - before);
    bytes.resize(before + step);
    const std::size_t got = source.read(std::span(bytes).subspan(before));
    bytes.resize(before + got);
    if (got < step) break;
  }
  return bytes;
}

}  // namespace spillway::formats
