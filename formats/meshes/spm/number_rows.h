#pragma once
// Numbers of triangles as rows of bytes, most of them small: docs/formats-meshes.md ("spm").

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "formats/meshes/spm/simplex_bytes.h"

namespace spillway::formats {

/// A number below kNarrow is a byte; below kFar its higher part is one, at least kNarrow, and its
/// lower part stands in a second row of bytes; any other is kFarByte and stands apart.
inline constexpr std::uint32_t kNarrow = 192;
inline constexpr std::uint32_t kFarByte = 255;
inline constexpr std::uint32_t kFar = kNarrow + (kFarByte - kNarrow) * 256;

/// The corners of a triangle but the first, less that.
using TriangleRest = std::array<std::uint32_t, 2>;

/// Both rows and what stands apart, as they are written.
class NumberRows {
 public:
  /// For at most so many numbers.
  explicit NumberRows(std::size_t most);

  /// Puts all numbers, but the first of a triangle that continues a fan (1, else 0).
  void put_triangles(std::span<const TriangleRest> triangles, const std::uint8_t* continues);

  void put_apart(std::uint32_t number) { far_.push_back(number); }

  void append_to(std::vector<std::byte>& out) const;

 private:
  /// Where the rows end. Bytes may alias anything, so that loops keep a copy of it.
  struct Ends {
    std::uint8_t* low;
    std::uint8_t* high;
  };

  /// Without a branch but for the last numbers of large blocks, as nobody can tell which numbers
  /// are taken and which are narrow.
  void put(Ends& ends, bool taken, std::uint32_t number) {
    if (number >= kFar) {
      if (!taken) return;
      *ends.low++ = kFarByte;
      far_.push_back(number);
      return;
    }
    const bool wide = number >= kNarrow;
    const std::uint32_t over = number - kNarrow;
    *ends.low = static_cast<std::uint8_t>(wide ? kNarrow + (over >> 8U) : number);
    ends.low += static_cast<std::ptrdiff_t>(taken);
    *ends.high = static_cast<std::uint8_t>(over);
    ends.high += static_cast<std::ptrdiff_t>(taken) & static_cast<std::ptrdiff_t>(wide);
  }

  void put_some(Ends& ends, std::span<const TriangleRest> triangles, const std::uint8_t* continues);
  std::size_t put_with_avx2(Ends& ends, std::span<const TriangleRest> triangles,
                            const std::uint8_t* continues);

  std::unique_ptr<std::uint8_t[]> low_;
  std::unique_ptr<std::uint8_t[]> high_;
  Ends ends_;
  std::vector<std::uint32_t> far_;
};

/// Appends how many triangles each first corner has, half a byte each; kManyHere and more go on in
/// `rows`. They are those from bounds[corner] to bounds[corner + 1].
void append_counts(std::vector<std::byte>& out, std::span<const std::uint32_t> bounds,
                   NumberRows& rows);

}  // namespace spillway::formats
