#pragma once
// What the readers of triangles and of tetrahedra have in common: docs/formats-meshes.md ("spm").

#include <fmt/format.h>

#include <cstddef>
#include <cstdint>
#include <span>

#include "src/error.h"

namespace spillway::formats {

/// How many simplices have a certain first corner, in half a byte; so many and more go on
/// elsewhere.
inline constexpr std::uint32_t kManyHere = 15;

/// The bytes of a block's simplices, taken off the front.
class SimplexBytes {
 public:
  SimplexBytes(std::span<const std::byte> bytes, const FileSpot& where)
      : left_(bytes), where_(where) {}

  [[nodiscard]] std::span<const std::byte> left() const { return left_; }

  /// The next bytes. Throws BadInput if there are fewer.
  std::span<const std::byte> take(std::size_t size) {
    if (left_.size() < size) fail("the simplices of a block end early");
    const std::span<const std::byte> taken = left_.first(size);
    left_ = left_.subspan(size);
    return taken;
  }

  [[noreturn]] void fail(const char* what) const {
    throw BadInput(where_, fmt::format("{}; the file is corrupt, make it again", what));
  }

  /// The i-th half byte, lower halves first.
  static std::uint32_t half(std::span<const std::byte> halves, std::size_t i) {
    return (std::to_integer<std::uint32_t>(halves[i / 2]) >> (4 * (i % 2))) & 15U;
  }

 private:
  std::span<const std::byte> left_;
  const FileSpot& where_;
};

}  // namespace spillway::formats
