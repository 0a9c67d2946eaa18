#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "formats/blocks/block.h"
#include "formats/bytes/bytes.h"
#include "formats/bytes/input_bytes.h"
#include "src/error.h"
#include "src/geometry/box.h"

namespace spillway::formats {

/// What streams of Spillway's own have in common.
struct BlockStreamFormat {
  std::string_view name;                      ///< "spm", "spp"
  std::string_view magic;                     ///< the first bytes
  std::uint32_t version = 0;                  ///< the newest that is known
  std::string_view contents = "stream";       ///< what messages call it
  std::size_t largest_block = kLargestBlock;  ///< bytes of content; what claims more is corrupt
  std::uint32_t oldest_version = 0;           ///< 0: that is the only one
};

/// Reads a stream of blocks, one after the other, and takes values off the front of each. All
/// faults are Errors that name the file and the byte where the block begins.
class BlockStream {
 public:
  /// Reads the magic. `so_far` says what has been given out, for a stream that is cut short:
  /// "7 points".
  BlockStream(std::unique_ptr<InputBytes> source, const BlockStreamFormat& format,
              std::function<std::string()> so_far);

  /// Reads the next block and returns its kind. Memory grows as bytes come.
  std::uint32_t next();

  /// Takes the version off the front, which must be one that is known.
  std::uint32_t take_version();

  /// Takes the lowest and the highest corner of a box off the front: finite and in this order.
  Box<3> take_extent();

  /// Takes a value off the front of the block.
  template <typename T>
  T take() {
    if (left_.size() < sizeof(T)) fail("a block ends early");
    const T value = load<T>(left_.data());
    left_ = left_.subspan(sizeof(T));
    return value;
  }

  /// The block as it came, and what has not been taken of it; valid until next().
  [[nodiscard]] std::span<const std::byte> content() const { return content_; }
  [[nodiscard]] std::span<const std::byte> left() const { return left_; }

  /// Throws Failure if anything follows the block, which is the last one.
  void expect_end();

  /// The file and the byte where the block begins.
  [[nodiscard]] FileSpot where() const;
  [[noreturn]] void fail(std::string_view what) const;

  [[nodiscard]] std::optional<double> fraction_read() const { return source_->fraction_read(); }

 private:
  void read_bytes(std::span<std::byte> bytes);

  std::unique_ptr<InputBytes> source_;
  BlockStreamFormat format_;
  std::function<std::string()> so_far_;
  std::uint64_t block_begin_ = 0;
  std::vector<std::byte> stored_;
  std::vector<std::byte> content_;
  std::span<const std::byte> left_;
};

}  // namespace spillway::formats
