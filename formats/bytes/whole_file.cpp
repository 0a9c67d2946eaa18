#include "formats/bytes/whole_file.h"

#include <algorithm>
#include <limits>
#include <optional>

namespace spillway::formats {
namespace {

constexpr std::uint64_t kStep = std::uint64_t{1} << 20;

/// What is read where a file should end, so that no more memory is taken for one that does.
constexpr std::uint64_t kBehindEnd = 4096;

}  // namespace

std::vector<std::byte> read_whole(InputBytes& source) {
  return read_up_to(source, std::numeric_limits<std::uint64_t>::max());
}

std::vector<std::byte> read_up_to(InputBytes& source, std::uint64_t count) {
  std::vector<std::byte> bytes;
  const std::optional<std::uint64_t> size = source.size();
  const std::uint64_t left = size ? *size - std::min(*size, source.position()) : 0;
  const std::uint64_t announced = std::min(count, left);
  if (size) bytes.reserve(announced + kBehindEnd);
  while (bytes.size() < count) {
    const std::uint64_t before = bytes.size();
    std::uint64_t step = std::min(kStep, count - before);
    if (size) step = std::min(step, before < announced ? announced - before : kBehindEnd);
    bytes.resize(before + step);
    const std::size_t got = source.read(std::span(bytes).subspan(before));
    bytes.resize(before + got);
    if (got < step) break;
  }
  return bytes;
}

}  // namespace spillway::formats
