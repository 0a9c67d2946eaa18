#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>

#include "formats/bytes/buffered_input.h"
#include "src/error.h"

namespace spillway::formats {

/// Throws Failure about what has just been read.
[[noreturn]] void fail_in_vtu(const BufferedInput& input, const std::string& what,
                              Remedy remedy = Remedy::kNone);

/// Throws Failure that says that the file ends too early.
[[noreturn]] void fail_at_end_of_vtu(const BufferedInput& input);

/// Passes over white space. Throws Failure for more of it than a file has that comes to an end.
void pass_over_blanks(BufferedInput& input);

/// The bytes that a VTU file holds as they are or in base64.
class VtuBytes {
 public:
  /// `input` must outlive it.
  explicit VtuBytes(BufferedInput& input) : input_(input) {}
  virtual ~VtuBytes() = default;
  VtuBytes(const VtuBytes&) = delete;
  VtuBytes& operator=(const VtuBytes&) = delete;

  /// Puts the next bytes into `room`. Throws Failure if there are fewer.
  void read(std::span<std::byte> room);

  /// Says that what was encoded in one go ends here, and something else follows.
  virtual void begin_next() = 0;

  /// The most bytes that can follow; nothing on a pipe.
  [[nodiscard]] virtual std::optional<std::uint64_t> most_left() const = 0;

  [[nodiscard]] BufferedInput& input() const { return input_; }

 protected:
  /// Puts as many bytes as there are, at most those that `room` has.
  virtual std::size_t read_some(std::span<std::byte> room) = 0;

 private:
  BufferedInput& input_;
};

/// Bytes as they are.
std::unique_ptr<VtuBytes> raw_vtu_bytes(BufferedInput& input);

/// Bytes in base64 (RFC 4648), which ends with its padding, a tag or the file; white space within
/// it is passed over.
std::unique_ptr<VtuBytes> base64_vtu_bytes(BufferedInput& input);

}  // namespace spillway::formats
