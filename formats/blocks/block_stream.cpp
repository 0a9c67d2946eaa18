#include "formats/blocks/block_stream.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "src/error.h"

namespace spillway::formats {

BlockStream::BlockStream(std::unique_ptr<InputBytes> source, const BlockStreamFormat& format,
                         std::function<std::string()> so_far)
    : source_(std::move(source)), format_(format), so_far_(std::move(so_far)) {
  source_->check_not_empty();
  std::vector<std::byte> magic(format.magic.size());
  source_->read(magic);
  if (as_text(magic) != format.magic) {
    throw BadInput(source_->name(),
                   fmt::format("no {} file: it does not begin with the format's magic; check the "
                               "name, or name its format",
                               format.name),
                   at_byte(0));
  }
}

std::uint32_t BlockStream::next() {
  constexpr std::size_t kPiece = std::size_t{4} << 20;
  block_begin_ = source_->position();
  std::array<std::byte, kBlockHeadSize> head_bytes;
  read_bytes(head_bytes);
  const BlockHead head = decode_block_head(head_bytes, where());
  if (head.content_size > format_.largest_block) fail("a block claims to be larger than any is");
  stored_.clear();
  while (stored_.size() < head.stored_size) {
    const std::size_t had = stored_.size();
    stored_.resize(std::min<std::size_t>(head.stored_size, had + kPiece));
    read_bytes(std::span(stored_).subspan(had));
  }
  decode_block(head, stored_, content_, where());
  left_ = content_;
  return head.kind;
}

std::uint32_t BlockStream::take_version() {
  const auto version = take<std::uint32_t>();
  const std::uint32_t newest = format_.version;
  const std::uint32_t oldest = format_.oldest_version == 0 ? newest : format_.oldest_version;
  if (version >= oldest && version <= newest) return version;
  const std::string known = oldest == newest ? fmt::format("only {} is", newest)
                                             : fmt::format("only {} to {} are", oldest, newest);
  throw BadInput(source_->name(),
                 fmt::format("version {} of {} is not known, {}; use the program that wrote it, "
                             "or a newer one",
                             version, format_.name, known),
                 at_byte(block_begin_));
}

Box<3> BlockStream::take_extent() {
  Box<3> extent;
  extent.lo = take<Point<3>>();
  extent.hi = take<Point<3>>();
  for (int axis = 0; axis < 3; ++axis) {
    if (!std::isfinite(extent.lo[axis]) || !(extent.lo[axis] <= extent.hi[axis]) ||
        !std::isfinite(extent.hi[axis])) {
      fail("the extent is invalid");
    }
  }
  return extent;
}

void BlockStream::expect_end() {
  std::byte more;
  if (source_->read({&more, 1}) == 0) return;
  block_begin_ = source_->position() - 1;
  fail("something follows the end");
}

FileSpot BlockStream::where() const { return {source_->name(), at_byte(block_begin_)}; }

void BlockStream::fail(std::string_view what) const {
  throw BadInput(where(), fmt::format("{}; the file is corrupt, make it again", what));
}

void BlockStream::read_bytes(std::span<std::byte> bytes) {
  if (source_->read(bytes) == bytes.size()) return;
  throw BadInput(
      source_->name(),
      fmt::format("the {} is cut short at byte {}, after {}; get a complete copy or make it again",
                  format_.contents, source_->position(), so_far_()),
      at_byte(source_->position()));
}

}  // namespace spillway::formats
