#pragma once
// Columns of numbers, so laid out that a byte compressor finds something: integers as differences
// from the one before, zigzag coded, in as many bytes as the largest needs, byte planes one after
// another; doubles that are no integers likewise, by their bits. docs/formats-blocks.md has the
// layout.

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "src/error.h"

namespace spillway::formats {

/// Appends a column. Values are restored to the bit, negative zero included. For doubles it tells
/// whether they went as integers, of less than 2^51 then.
bool append_column(std::vector<std::byte>& out, std::span<const double> values);
void append_column(std::vector<std::byte>& out, std::span<const std::uint64_t> values);
void append_column(std::vector<std::byte>& out, std::span<const std::uint32_t> values);

/// Appends records of bytes, all of one size: the first bytes of all, then their second ones, and
/// so on.
void append_byte_planes(std::vector<std::byte>& out, std::span<const std::byte> records,
                        std::size_t record_size);

/// Takes columns off the front of `bytes`. The number of values is the caller's to know, and to
/// bound, since equal steps take no bytes. Throws BadInput of `where` if bytes are missing
///  or make no sense; otherwise allocates nothing that the bytes do not back.
class ColumnReader {
 public:
  ColumnReader(std::span<const std::byte> bytes, FileSpot where);

  void read(std::size_t count, std::vector<double>& values);
  void read(std::size_t count, std::vector<std::uint64_t>& values);
  void read(std::size_t count, std::vector<std::uint32_t>& values);
  /// Takes all that is left as the byte planes of so many records, at least one.
  void read_byte_planes(std::size_t count, std::vector<std::byte>& records);

  /// What is left.
  [[nodiscard]] std::span<const std::byte> left() const { return left_; }
  /// Throws Failure if anything is left.
  void expect_end() const;

 private:
  std::span<const std::byte> left_;
  FileSpot where_;
};

}  // namespace spillway::formats
