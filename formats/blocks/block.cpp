#include "formats/blocks/block.h"

#include <fmt/format.h>
#include <xxhash.h>

#include <array>
#include <memory>

#include "formats/bytes/bytes.h"
#include "formats/compression/lz4.h"
#include "src/error.h"

namespace spillway::formats {
namespace {

// Where the head's fields are.
constexpr std::size_t kKindAt = 0;
constexpr std::size_t kContentSizeAt = 4;
constexpr std::size_t kStoredSizeAt = 8;
constexpr std::size_t kCompressedAt = 12;
constexpr std::size_t kChecksumAt = 16;

void encode_fields(const BlockHead& head, std::byte* bytes) {
  store(bytes + kKindAt, head.kind);
  store(bytes + kContentSizeAt, head.content_size);
  store(bytes + kStoredSizeAt, head.stored_size);
  store(bytes + kCompressedAt, static_cast<std::uint32_t>(head.compressed));
}

/// The hash of the fields is the seed for that of the stored bytes.
std::uint64_t checksum_of(const BlockHead& head, const std::byte* stored) {
  std::array<std::byte, kChecksumAt> fields;
  encode_fields(head, fields.data());
  const std::uint64_t seed = XXH3_64bits(fields.data(), fields.size());
  return XXH3_64bits_withSeed(stored, head.stored_size, seed);
}

[[noreturn]] void fail(const FileSpot& where, const char* what) {
  throw BadInput(where, fmt::format("{}; the file is corrupt, make it again", what));
}

}  // namespace

void append_block(std::vector<std::byte>& out, std::uint32_t kind,
                  std::span<const std::byte> content) {
  if (content.size() > kLargestBlock) {
    throw Failure(fmt::format("a block of {} bytes is too large to write; the limit is {}",
                              content.size(), kLargestBlock),
                  ErrorCode::kTooLarge);
  }
  BlockHead head;
  head.kind = kind;
  head.content_size = static_cast<std::uint32_t>(content.size());
  // What does not get shorter is stored as it is: LZ4 stops when its room is used up.
  const auto room = std::make_unique_for_overwrite<std::byte[]>(content.size());
  const std::size_t compressed =
      content.size() <= 1 ? 0 : lz4_compress(content, {room.get(), content.size() - 1});
  head.compressed = compressed > 0;
  const std::span<const std::byte> stored =
      head.compressed ? std::span<const std::byte>(room.get(), compressed) : content;
  head.stored_size = static_cast<std::uint32_t>(stored.size());
  head.checksum = checksum_of(head, stored.data());
  std::array<std::byte, kBlockHeadSize> bytes;
  encode_fields(head, bytes.data());
  store(bytes.data() + kChecksumAt, head.checksum);
  out.insert(out.end(), bytes.begin(), bytes.end());
  out.insert(out.end(), stored.begin(), stored.end());
}

BlockHead decode_block_head(std::span<const std::byte, kBlockHeadSize> bytes,
                            const FileSpot& where) {
  BlockHead head;
  head.kind = load<std::uint32_t>(bytes.data() + kKindAt);
  head.content_size = load<std::uint32_t>(bytes.data() + kContentSizeAt);
  head.stored_size = load<std::uint32_t>(bytes.data() + kStoredSizeAt);
  const auto compressed = load<std::uint32_t>(bytes.data() + kCompressedAt);
  head.compressed = compressed == 1;
  head.checksum = load<std::uint64_t>(bytes.data() + kChecksumAt);
  const bool sizes_fit = head.compressed ? head.stored_size < head.content_size &&
                                               head.content_size <= kLargestRatio * head.stored_size
                                         : head.stored_size == head.content_size;
  if (compressed > 1 || !sizes_fit || head.content_size > kLargestBlock) {
    fail(where, "the head of a block is invalid");
  }
  return head;
}

void decode_block(const BlockHead& head, std::span<const std::byte> stored,
                  std::vector<std::byte>& content, const FileSpot& where) {
  if (stored.size() != head.stored_size) fail(where, "the block ends early");
  if (checksum_of(head, stored.data()) != head.checksum) {
    fail(where, "the checksum of the block does not fit its bytes");
  }
  if (!head.compressed) {
    content.assign(stored.begin(), stored.end());
    return;
  }
  content.resize(head.content_size);
  if (!lz4_decompress(stored, content)) {
    fail(where, "the block does not decompress to the size in its head");
  }
}

}  // namespace spillway::formats
