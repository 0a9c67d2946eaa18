#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "formats/points/attributes/record_conversion.h"
#include "formats/points/common/point_writer.h"
#include "formats/points/las/las_crs.h"
#include "formats/points/las/laz_record.h"
#include "formats/points/las/records/las_metadata.h"
#include "formats/points/las/records/las_target.h"
#include "src/geometry/box.h"
#include "src/geometry/lattice.h"

namespace spillway::formats {

/// What LAS and LAZ that are written have in common: records of points, and the header that tells
/// of them. docs/formats-points.md ("LAS, written").
class LasContent {
 public:
  /// `file_name` is for messages. Throws Failure for what LAS cannot hold.
  LasContent(std::string file_name, const PointWriterOptions& options,
             LasProfile profile = LasProfile::kAny);

  [[nodiscard]] const LasTarget& target() const { return target_; }
  [[nodiscard]] std::size_t record_length() const { return record_length_; }

  /// The file is LAZ: its header says so, and has this record behind those of LAS.
  void compress(const LazRecord& laz);

  /// The file has this record before all others.
  void put_first(const LasVlr& record);
  /// The file has this record behind the points, before others that are there.
  void put_behind_points(LasVlr record);

  /// All that is before the points, while none has come: right, if wide, wherever nobody can come
  /// back to write the final header.
  [[nodiscard]] std::vector<std::byte> head() const;

  /// Appends the records of these points, which come in the order of the file; attributes as in
  /// PointWriter::write(). Throws Failure for points that a record cannot hold.
  void append_records(std::span<const LatticePoint> points, std::span<const std::byte> attributes,
                      std::vector<std::byte>& out);

  /// The byte after the points, if they are not compressed.
  [[nodiscard]] std::uint64_t end_of_records() const;
  /// The records that follow the points, from byte `begin` on. final_header() tells of them then.
  std::vector<std::vector<std::byte>> extended_records(std::uint64_t begin);

  /// The public header block when all points have come: what head() begins with.
  [[nodiscard]] std::vector<std::byte> final_header() const;

  /// Points that have come.
  [[nodiscard]] std::uint64_t count() const { return count_; }

 private:
  static constexpr std::size_t kReturns = 15;  // of LAS 1.4
  /// Number of points by return number, which 4 bits hold.
  using ReturnCounts = std::array<std::uint64_t, kReturns + 1>;

  [[nodiscard]] bool counts_with_64_bits() const { return target_.minor_version >= 4; }
  void keep_what_version_holds();
  void leave_out_waveforms();
  void put_coordinates(std::span<const LatticePoint> points, std::byte* records);
  void put_attributes(std::span<const std::byte> attributes, std::size_t count,
                      std::byte* records) const;
  void count_returns(const std::byte* records, std::size_t count);
  [[noreturn]] void fail_at_first_invalid(std::span<const LatticePoint> points) const;
  [[nodiscard]] std::vector<std::byte> header(std::uint64_t count, const Box<3>& bounds,
                                              const ReturnCounts& returns) const;

  std::string file_name_;
  std::optional<std::uint64_t> promised_;
  LasTarget target_;
  std::size_t record_length_;
  AttributeLayout attributes_;
  RecordConversion packing_;
  std::vector<std::byte> first_record_;  // what a record has before attributes are put into it
  IntegerLattice lattice_;
  LasMetadata las_;               // of the inputs, or nothing
  std::uint16_t encoding_ = 0;    // the global encoding
  std::vector<std::byte> first_;  // a variable length record
  std::vector<std::byte> vlrs_;   // all others but that of LAZ
  std::uint32_t vlr_count_ = 0;
  std::vector<std::byte> laz_;  // the record that tells of the compression
  std::uint64_t count_ = 0;
  Box<3> bounds_;           // of the integers so far
  ReturnCounts returns_{};  // of the points so far
  std::uint64_t extended_at_ = 0;
  std::uint32_t extended_count_ = 0;
  std::uint64_t waveforms_at_ = 0;
};

}  // namespace spillway::formats
