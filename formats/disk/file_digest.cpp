#include "formats/disk/file_digest.h"

#include <xxhash.h>

#include <algorithm>
#include <vector>

namespace spillway::formats {
namespace {

constexpr std::uint64_t kFirst = std::uint64_t{256} << 10;
constexpr std::uint64_t kLast = std::uint64_t{64} << 10;
constexpr std::uint64_t kPiece = std::uint64_t{4} << 10;
constexpr std::uint64_t kPieces = 14;

}  // namespace

FileDigest digest_of(InputFile& file) {
  FileDigest digest{.size = file.size().value_or(0), .hash = 0};
  std::vector<std::byte> bytes;
  const auto look_at = [&](std::uint64_t begin, std::uint64_t end) {
    bytes.resize(std::min(end, digest.size) - begin);
    file.seek(begin);
    bytes.resize(file.read(bytes));
    digest.hash = XXH3_64bits_withSeed(bytes.data(), bytes.size(), digest.hash);
  };
  look_at(0, kFirst);
  if (digest.size <= kFirst) return digest;
  const std::uint64_t last = std::max(kFirst, digest.size - std::min(digest.size, kLast));
  const std::uint64_t distance = (last - kFirst) / (kPieces + 1);
  for (std::uint64_t i = 1; i <= kPieces && distance > kPiece; ++i) {
    look_at(kFirst + i * distance, kFirst + i * distance + kPiece);
  }
  look_at(last, digest.size);
  return digest;
}

}  // namespace spillway::formats
