#include "stream/sinks/line_store.h"

namespace spillway::stream {
namespace {

/// Bytes that go to the disk at a time.
constexpr std::size_t kBatch = std::size_t{1} << 20;

}  // namespace

void LineStore::add(std::span<const Point<2>> points, std::int64_t level) {
  put(last_, points, level);
  if (last_.bytes().size() < kBatch) return;
  if (!file_) file_ = scratch_.create("contours");
  batches_.push_back({file_->size(), last_.bytes().size()});
  file_->append(last_.bytes());
  last_ = {};
}

std::vector<std::byte> LineStore::take() {
  if (next_ == batches_.size()) return last_.take();
  const Batch& batch = batches_[next_++];
  std::vector<std::byte> bytes(batch.bytes);
  file_->read(batch.offset, bytes);
  return bytes;
}

}  // namespace spillway::stream
