#include "formats/points/laz/chunk_input.h"

#include <algorithm>

#include "src/error.h"

namespace spillway::formats::laz {

std::span<const std::byte> ChunkInput::take(std::size_t size, std::vector<std::byte>& gathered) {
  if (rest_.empty() && size > 0) next_span();
  std::span<const std::byte> taken = rest_.first(std::min(size, rest_.size()));
  rest_ = rest_.subspan(taken.size());
  if (taken.size() == size) return taken;
  gathered.assign(taken.begin(), taken.end());
  while (gathered.size() < size) {
    if (rest_.empty()) next_span();
    taken = rest_.first(std::min(size - gathered.size(), rest_.size()));
    gathered.insert(gathered.end(), taken.begin(), taken.end());
    rest_ = rest_.subspan(taken.size());
  }
  return gathered;
}

void ChunkInput::skip(std::uint64_t size) {
  while (size > 0) {
    if (rest_.empty()) next_span();
    const auto skipped = static_cast<std::size_t>(std::min<std::uint64_t>(size, rest_.size()));
    rest_ = rest_.subspan(skipped);
    size -= skipped;
  }
}

void ChunkInput::next_span() {
  rest_ = bytes_->more();
  if (rest_.empty()) throw Failure("the compressed chunk ends too early");
}

}  // namespace spillway::formats::laz
