#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <mutex>
#include <span>
#include <string>
#include <utility>

#include "formats/disk/scratch_folder.h"

namespace spillway::stream {

/// A scratch file that many threads append to and read from.
class SharedScratch {
 public:
  /// The file is made when it is first needed. `folder` must outlive it.
  SharedScratch(ScratchFolder& folder, std::string label)
      : folder_(folder), label_(std::move(label)) {}

  /// Returns where the bytes begin.
  std::uint64_t append(std::span<const std::byte> bytes) {
    const std::lock_guard lock(mutex_);
    if (!file_) file_ = folder_.create(label_);
    const std::uint64_t offset = file_->size();
    file_->append(bytes);
    return offset;
  }

  /// Fills `bytes` from `offset` on.
  void read(std::uint64_t offset, std::span<std::byte> bytes) const {
    const std::lock_guard lock(mutex_);
    file_->read(offset, bytes);
  }

  [[nodiscard]] std::uint64_t size() const {
    const std::lock_guard lock(mutex_);
    return file_ ? file_->size() : 0;
  }

 private:
  ScratchFolder& folder_;
  const std::string label_;
  mutable std::mutex mutex_;  ///< guards the next one
  std::unique_ptr<ScratchFile> file_;
};

}  // namespace spillway::stream
