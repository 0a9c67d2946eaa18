#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "formats/points/common/point_writer.h"
#include "formats/points/las/las_crs.h"
#include "formats/points/las/laz_record.h"
#include "src/geometry/box.h"
#include "src/geometry/lattice.h"

namespace spillway::detail {

/// What LAS and LAZ that are written have in common: records of points, and the header that tells
/// of them. docs/formats-points.md ("LAS, written").
class LasContent {
 public:
  /// `file_name` is for messages. Throws Error for what LAS cannot hold.
  LasContent(std::string file_name, const PointWriterOptions& options);

  /// 0 or 6.
  [[nodiscard]] int point_format() const { return version14_ ? 6 : 0; }
  [[nodiscard]] std::size_t record_length() const { return record_length_; }

  /// The file is LAZ: its header says so, and has this record behind those of LAS.
  void compress(const LazRecord& laz);

  /// All that is before the points, while none has come: right, if wide, wherever nobody can come
  /// back to write the final header.
  [[nodiscard]] std::vector<std::byte> head() const;

  /// Appends the records of these points, which come in the order of the file; attributes as in
  /// PointWriter::write(). Throws Error for points that a record cannot hold.
  void append_records(std::span<const LatticePoint> points,
                      std::span<const PointAttributes> attributes, std::vector<std::byte>& out);

  /// The public header block when all points have come: what head() begins with.
  [[nodiscard]] std::vector<std::byte> final_header() const;

  /// Points that have come.
  [[nodiscard]] std::uint64_t count() const { return count_; }

 private:
  static constexpr std::size_t kReturns = 15;  // of LAS 1.4
  /// Number of points by return number, which 4 bits hold.
  using ReturnCounts = std::array<std::uint64_t, kReturns + 1>;

  std::int32_t to_int32(double value);
  [[nodiscard]] bool holds(const PointAttributes& attributes) const;
  void put_attributes(std::byte* record, const PointAttributes& attributes);
  [[noreturn]] void fail_at_first_invalid(std::span<const LatticePoint> points,
                                          std::span<const PointAttributes> attributes) const;
  [[nodiscard]] std::vector<std::byte> header(std::uint64_t count, const Box<3>& bounds,
                                              const ReturnCounts& returns) const;

  std::string file_name_;
  std::optional<std::uint64_t> promised_;
  bool attributes_come_;
  bool version14_;
  std::size_t record_length_;
  Lattice lattice_;
  LasCrs crs_;
  std::vector<std::byte> laz_;  // the record that tells of the compression
  std::uint64_t count_ = 0;
  Box<3> bounds_;           // of the integers so far
  ReturnCounts returns_{};  // of the points so far
  bool invalid_ = false;    // the current points have one that LAS cannot hold
};

}  // namespace spillway::detail
