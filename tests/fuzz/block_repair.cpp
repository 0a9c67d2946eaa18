#include "tests/fuzz/block_repair.h"

#include <xxhash.h>

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <functional>
#include <span>
#include <vector>

#include "formats/blocks/block.h"
#include "formats/bytes/bytes.h"

namespace spillway::test {
namespace {

constexpr std::size_t kStoredSizeAt = 8;
constexpr std::size_t kFieldsSize = 16;

/// What belongs to the head of a block: docs/formats-blocks.md.
std::uint64_t checksum_of(const char* head, const char* stored, std::size_t size) {
  return XXH3_64bits_withSeed(stored, size, XXH3_64bits(head, kFieldsSize));
}

std::uint32_t stored_size_of(std::string_view bytes, std::size_t at) {
  return formats::load<std::uint32_t>(
      reinterpret_cast<const std::byte*>(bytes.data() + at + kStoredSizeAt));
}

/// Calls `use` for each block that is whole, by where it begins and its stored size. What follows
/// the last of them begins where it returns.
std::size_t for_each_block(std::string_view bytes, std::size_t at,
                           const std::function<void(std::size_t, std::size_t)>& use) {
  while (at + kBlockHeadSize <= bytes.size()) {
    const std::size_t size = stored_size_of(bytes, at);
    if (size > bytes.size() - at - kBlockHeadSize) break;
    use(at, size);
    at += kBlockHeadSize + size;
  }
  return std::min(at, bytes.size());
}

}  // namespace

std::string with_right_checksums(std::string_view bytes, std::size_t begin) {
  std::string repaired(bytes);
  for_each_block(bytes, begin, [&](std::size_t at, std::size_t size) {
    char* const head = repaired.data() + at;
    const std::uint64_t checksum = checksum_of(head, head + kBlockHeadSize, size);
    std::memcpy(head + kFieldsSize, &checksum, sizeof(checksum));
  });
  return repaired;
}

std::string with_plain_blocks(std::string_view bytes, std::size_t begin) {
  std::string plain(bytes.substr(0, begin));
  const std::size_t end = for_each_block(bytes, begin, [&](std::size_t at, std::size_t size) {
    const std::span<const std::byte> block =
        std::as_bytes(std::span(bytes.substr(at, kBlockHeadSize + size)));
    BlockHead head = decode_block_head(block.first<kBlockHeadSize>(), {"a seed"});
    std::vector<std::byte> content;
    decode_block(head, block.subspan(kBlockHeadSize), content, {"a seed"});
    const auto length = static_cast<std::uint32_t>(content.size());
    const std::uint32_t fields[] = {head.kind, length, length, 0};
    plain.append(reinterpret_cast<const char*>(fields), sizeof(fields));
    plain.append(sizeof(std::uint64_t), '\0');
    plain.append(reinterpret_cast<const char*>(content.data()), content.size());
  });
  plain += bytes.substr(end);
  return with_right_checksums(plain, begin);
}

}  // namespace spillway::test
