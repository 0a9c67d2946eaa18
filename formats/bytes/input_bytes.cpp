#include "formats/bytes/input_bytes.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "src/error.h"

namespace spillway::formats {

std::span<const std::byte> InputBytes::peek(std::size_t count) {
  peeked_.erase(peeked_.begin(), peeked_.begin() + static_cast<std::ptrdiff_t>(peeked_read_));
  peeked_read_ = 0;
  if (peeked_.size() < count) {
    const std::size_t had = peeked_.size();
    peeked_.resize(count);
    peeked_.resize(had + file_->read(std::span(peeked_).subspan(had)));
  }
  return std::span(peeked_).first(std::min(count, peeked_.size()));
}

void InputBytes::check_not_empty() {
  if (peek(1).empty()) {
    throw BadInput(name(), "the input is empty; see why nothing was written to it", at_byte(0));
  }
}

std::size_t InputBytes::read(std::span<std::byte> buffer) {
  const std::size_t from_peeked = std::min(buffer.size(), peeked_.size() - peeked_read_);
  std::copy_n(peeked_.begin() + static_cast<std::ptrdiff_t>(peeked_read_), from_peeked,
              buffer.begin());
  peeked_read_ += from_peeked;
  const std::span<std::byte> rest = buffer.subspan(from_peeked);
  const std::size_t done = from_peeked + (rest.empty() ? 0 : file_->read(rest));
  position_ += done;
  return done;
}

bool InputBytes::seek(std::uint64_t position) {
  if (!file_->seek(position)) return false;
  peeked_read_ = peeked_.size();
  position_ = position;
  return true;
}

bool InputBytes::skip(std::uint64_t count) {
  std::array<std::byte, 65536> dropped;
  while (count > 0) {
    const auto wanted = static_cast<std::size_t>(std::min<std::uint64_t>(count, dropped.size()));
    if (read(std::span(dropped).first(wanted)) < wanted) return false;
    count -= wanted;
  }
  return true;
}

std::optional<double> InputBytes::fraction_read() const {
  const std::optional<std::uint64_t> total = size();
  if (!total) return std::nullopt;
  if (*total == 0) return 1.0;
  return std::min(1.0, static_cast<double>(position_) / static_cast<double>(*total));
}

}  // namespace spillway::formats
