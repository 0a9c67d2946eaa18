#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "formats/bytes/number_type.h"
#include "formats/meshes/vtu/vtu_bytes.h"
#include "formats/meshes/vtu/vtu_header.h"

namespace spillway::formats {

/// The content of one array of a VTU file, as bytes: whatever it was written in, decompressed.
class VtuContent {
 public:
  VtuContent() = default;
  virtual ~VtuContent() = default;
  VtuContent(const VtuContent&) = delete;
  VtuContent& operator=(const VtuContent&) = delete;

  /// Puts the next bytes into `room`; fewer than that at the end only. Throws Failure.
  virtual std::size_t read(std::span<std::byte> room) = 0;

  /// Bytes of the whole, if the file is known to hold them.
  [[nodiscard]] virtual std::optional<std::uint64_t> size() const { return std::nullopt; }
};

/// The numbers of one array of a VTU file, one after another.
class VtuValues {
 public:
  /// Numbers of `array` in binary. `bytes`, which must outlive it, stand before its length. Throws
  /// Failure for lengths that cannot be.
  static VtuValues of_binary(VtuBytes& bytes, const VtuCoding& coding, const VtuArray& array);

  /// Numbers of `array` in text, up to the next tag. `input` must outlive it.
  static VtuValues of_text(BufferedInput& input, const VtuArray& array);

  /// Goes to the next number; false at the end of the array. Throws Failure.
  bool next() {
    at_ += size_of_one_;
    return at_ < end_ || refill();
  }

  /// The number that next() went to.
  [[nodiscard]] double number() const { return load_number(type_, buffer_.data() + at_, swaps_); }

  /// The same as an index; nothing if it is negative or not whole.
  [[nodiscard]] std::optional<std::uint64_t> index() const {
    return load_index(type_, buffer_.data() + at_, swaps_);
  }

  /// Puts it at `at`, as a number of that type; false if it is none.
  [[nodiscard]] bool put(NumberType type, std::byte* at) const;

  /// How many numbers there are, if the file is known to hold them.
  [[nodiscard]] std::optional<std::uint64_t> count() const;

 private:
  VtuValues(std::unique_ptr<VtuContent> content, BufferedInput& input, NumberType type, bool swaps);

  bool refill();

  std::unique_ptr<VtuContent> content_;
  BufferedInput& input_;
  NumberType type_;
  bool swaps_;
  std::size_t size_of_one_;
  std::vector<std::byte> buffer_;
  std::size_t at_ = 0;   // byte of the number in the buffer
  std::size_t end_ = 0;  // of what the buffer holds
};

}  // namespace spillway::formats
