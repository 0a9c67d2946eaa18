#include "formats/state/state_writer.h"

#include <algorithm>
#include <string>
#include <utility>

#include "formats/blocks/block.h"
#include "formats/disk/kept_scratch.h"
#include "formats/state/state_blocks.h"

namespace spillway::formats {

void StateWriter::bytes(const void* bytes, std::size_t size) {
  std::span<const std::byte> left(static_cast<const std::byte*>(bytes), size);
  while (!left.empty()) {
    const std::size_t taken = std::min(left.size(), kStateBlockBytes - block_.size());
    block_.insert(block_.end(), left.begin(), left.begin() + static_cast<std::ptrdiff_t>(taken));
    left = left.subspan(taken);
    if (block_.size() == kStateBlockBytes) put_block(kStateBlock);
  }
}

void StateWriter::section(std::string_view name) {
  std::string text(name);
  (*this)(text);
}

void StateWriter::file(std::shared_ptr<ScratchFile>& file) {
  std::uint32_t number = 0;
  if (file == nullptr) return (*this)(number);
  const auto [place, is_new] =
      files_.emplace(file.get(), static_cast<std::uint32_t>(files_.size() + 1));
  number = place->second;
  (*this)(number);
  if (!is_new) return;
  std::string name = KeptScratchFolder::file_name_of(*file);
  std::uint64_t size = file->size();
  (*this)(name, size);
}

std::uint64_t StateWriter::finish() {
  put_block(kLastStateBlock);
  file_->sync();
  file_->commit();
  return written_;
}

void StateWriter::put_block(std::uint32_t kind) {
  encoded_.clear();
  append_block(encoded_, kind, block_);
  file_->write(encoded_);
  written_ += encoded_.size();
  block_.clear();
}

}  // namespace spillway::formats
