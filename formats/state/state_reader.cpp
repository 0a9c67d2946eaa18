#include "formats/state/state_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <optional>
#include <span>
#include <string>

#include "formats/blocks/block.h"
#include "formats/state/state_blocks.h"
#include "src/error.h"

namespace spillway::formats {

/// What `read` returns; adds to its errors what to do.
template <typename Read>
auto StateReader::sound(const Read& read) const {
  try {
    return read();
  } catch (const BadInput& error) {
    throw Failure(with_remedy(error), error.code(), error.facts());
  }
}

std::string StateReader::with_remedy(const BadInput& error) const {
  return fmt::format("{}; remove {} to begin again", error.what(), run_folder_);
}

void StateReader::bytes(void* bytes, std::size_t size) {
  auto* to = static_cast<std::byte*>(bytes);
  while (size > 0) {
    while (taken_ == block_.size()) take_block();
    const std::size_t some = std::min(size, block_.size() - taken_);
    std::memcpy(to, block_.data() + taken_, some);
    taken_ += some;
    to += some;
    size -= some;
  }
}

void StateReader::check_size(std::uint64_t elements) const {
  const std::uint64_t in_memory = block_.size() - taken_;
  const std::optional<std::uint64_t> size = file_->size();
  if (!size) return;
  const std::uint64_t behind = *size - std::min(*size, block_begin_);
  if (elements > in_memory && (elements - in_memory) / kLargestRatio > behind) {
    fail("the state ends early");
  }
}

bool StateReader::truth_of(unsigned char byte) const {
  if (byte > 1) fail("a value is neither true nor false");
  return byte == 1;
}

void StateReader::section(std::string_view name) {
  std::uint64_t size = 0;
  (*this)(size);
  std::string text(std::min<std::uint64_t>(size, name.size()), ' ');
  bytes(text.data(), text.size());
  if (size != name.size() || text != name) {
    fail(fmt::format("the state of \"{}\" is not where it should be", name));
  }
}

void StateReader::file(std::shared_ptr<ScratchFile>& file) {
  std::uint32_t number = 0;
  (*this)(number);
  if (number == 0) return file.reset();
  std::shared_ptr<ScratchFile>& known = files_[number];
  if (!known) {
    std::string name;
    std::uint64_t size = 0;
    (*this)(name, size);
    if (scratch_ == nullptr) fail("a scratch file is where none should be");
    known = sound([&] { return scratch_->reopen(name, size); });
  }
  file = known;
}

void StateReader::finish() {
  if (taken_ != block_.size() || !is_last_) fail("more follows than was expected");
}

void StateReader::take_block() {
  if (is_last_) fail("the state ends early");
  std::array<std::byte, kBlockHeadSize> head_bytes{};
  if (file_->read(head_bytes) < head_bytes.size()) fail("the file is cut short");
  const FileSpot where{file_->name(), at_byte(block_begin_)};
  const BlockHead head = sound([&] { return decode_block_head(head_bytes, where); });
  if (head.kind != kStateBlock && head.kind != kLastStateBlock) fail("this is no state of a run");
  if (head.content_size > kStateBlockBytes || head.stored_size > 2 * kStateBlockBytes) {
    fail("a block is larger than any");
  }
  stored_.resize(head.stored_size);
  if (file_->read(stored_) < stored_.size()) fail("the file is cut short");
  sound([&] { decode_block(head, stored_, block_, where); });
  block_begin_ += head_bytes.size() + stored_.size();
  is_last_ = head.kind == kLastStateBlock;
  taken_ = 0;
  std::byte more{};
  if (is_last_ && file_->read({&more, 1}) != 0) fail("something follows the end");
}

void StateReader::fail(std::string_view what) const {
  const BadInput error(FileSpot{file_->name(), at_byte(block_begin_)}, std::string(what));
  throw Failure(with_remedy(error), error.code(), error.facts());
}

}  // namespace spillway::formats
