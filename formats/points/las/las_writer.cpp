#include "formats/points/las/las_writer.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <string_view>
#include <utility>
#include <vector>

#include "formats/bytes/bytes.h"
#include "formats/points/las/las_crs.h"
#include "formats/points/las/las_header.h"
#include "src/error.h"
#include "src/geometry/box.h"

namespace spillway::detail {
namespace {

constexpr std::size_t kBlockPoints = 8192;
constexpr double kLeast = std::numeric_limits<std::int32_t>::min();
constexpr double kMost = std::numeric_limits<std::int32_t>::max();
constexpr std::uint64_t kMostLegacyPoints = std::numeric_limits<std::uint32_t>::max();
constexpr std::size_t kLegacyReturns = 5;  // that a header counts
constexpr std::size_t kReturns = 15;       // from 1.4
constexpr PointAttributes kSingleReturn{.return_number = 1, .return_count = 1};

/// Number of points by return number, which 4 bits hold.
using ReturnCounts = std::array<std::uint64_t, kReturns + 1>;

/// Whether the file is LAS 1.4 with point format 6, not 1.2 with point format 0.
bool is_version14(const OutputFile& file, const PointWriterOptions& options) {
  const bool large = options.count && *options.count > kMostLegacyPoints;
  if (options.version.empty()) return large;
  if (options.version != "1.2" && options.version != "1.4") {
    throw InvalidArgument(fmt::format("cannot write {}: LAS {} is not written; choose 1.2 or 1.4",
                                      file.name(), options.version),
                          {.file = file.name()});
  }
  if (options.version == "1.2" && large) {
    throw InvalidArgument(
        fmt::format("cannot write {}: {} points are more than LAS 1.2 counts; choose "
                    "1.4",
                    file.name(), *options.count),
        {.file = file.name()});
  }
  return options.version == "1.4";
}

class LasWriter : public PointWriter {
 public:
  LasWriter(std::unique_ptr<OutputFile> file, const PointWriterOptions& options)
      : file_(std::move(file)),
        count_(options.count),
        version14_(is_version14(*file_, options)),
        record_length_(kLasRecordLengths[version14_ ? 6 : 0]) {
    if (!options.lattice) {
      throw CannotWrite(file_->name(),
                        "LAS holds integers with a scale, and these points have none; write spp, "
                        "npy or text, or round them with convert");
    }
    if (options.coordinates != 3) {
      throw CannotWrite(file_->name(), "LAS points have three coordinates; write text or npy");
    }
    lattice_ = *options.lattice;
    try {
      crs_ = las_crs(options.crs, options.crs_wkt, version14_);
    } catch (const Error& error) {
      throw CannotWrite(file_->name(), error.what(), error.code());
    }
    records_.resize(kBlockPoints * record_length_);
    // Right, if wide, wherever finish() cannot come back to write the tight ones.
    ReturnCounts returns{};
    if (!options.attributes) returns[1] = count_.value_or(0);
    std::vector<std::byte> head =
        header(count_.value_or(0), {{kLeast, kLeast, kLeast}, {kMost, kMost, kMost}}, returns);
    head.insert(head.end(), crs_.bytes.begin(), crs_.bytes.end());
    file_->write(head);
  }

  void write(std::span<const LatticePoint> points,
             std::span<const PointAttributes> attributes) override {
    while (!points.empty()) {
      const std::size_t size = std::min(points.size(), kBlockPoints);
      const std::span<const PointAttributes> block =
          attributes.first(std::min(attributes.size(), size));
      write_block(points.first(size), block);
      points = points.subspan(size);
      attributes = attributes.subspan(block.size());
    }
  }

  void finish() override {
    check_written(*file_, count_, written_);
    if (written_ == 0) bounds_ = {{0, 0, 0}, {0, 0, 0}};
    file_->rewrite(0, header(written_, bounds_, returns_));
    file_->commit();
  }

 private:
  void write_block(std::span<const LatticePoint> points,
                   std::span<const PointAttributes> attributes) {
    if (!version14_ && written_ + points.size() > kMostLegacyPoints) {
      throw CannotWrite(
          file_->name(),
          fmt::format("more than {} points come, and LAS 1.2 counts no further", kMostLegacyPoints),
          ErrorCode::kTooLarge, at_record(kMostLegacyPoints), Remedy::kLas14);
    }
    std::byte* record = records_.data();
    for (std::size_t i = 0; i < points.size(); ++i, record += record_length_) {
      bounds_.expand(points[i]);
      for (std::size_t axis = 0; axis < 3; ++axis) {
        store(record + 4 * axis, to_int32(points[i][axis]));
      }
      put_attributes(record, attributes.empty() ? kSingleReturn : attributes[i]);
    }
    if (invalid_) fail_at_first_invalid(points, attributes);
    file_->write(std::span(records_).first(points.size() * record_length_));
    written_ += points.size();
  }

  /// Remembers in invalid_ if the value is no 32-bit integer.
  std::int32_t to_int32(double value) {
    const bool in_range = value >= kLeast && value <= kMost;
    const auto integer = static_cast<std::int32_t>(in_range ? value : 0.0);
    invalid_ |= static_cast<double>(integer) != value;
    return integer;
  }

  /// Whether a record has the bits for them.
  [[nodiscard]] bool holds(const PointAttributes& a) const {
    if (version14_) return a.return_number <= kReturns && a.return_count <= kReturns;
    return a.return_number <= 7 && a.return_count <= 7 && a.classification <= 31 &&
           (a.flags & PointAttributes::kOverlap) == 0;
  }

  /// Bytes 14 to 16 of a record: docs/formats-points.md ("LAS, written"). All others stay 0.
  void put_attributes(std::byte* record, const PointAttributes& a) {
    const unsigned number = a.return_number;
    const unsigned count = a.return_count;
    const unsigned flags = a.flags;
    if (version14_) {
      store(record + 14, static_cast<std::uint8_t>(number | (count << 4U)));
      store(record + 15, a.flags);
      store(record + 16, a.classification);
    } else {
      store(record + 14, static_cast<std::uint8_t>(number | (count << 3U)));
      store(record + 15, static_cast<std::uint8_t>(a.classification | (flags << 5U)));
    }
    ++returns_[number & kReturns];
    invalid_ |= !holds(a);
  }

  [[noreturn]] void fail_at_first_invalid(std::span<const LatticePoint> points,
                                          std::span<const PointAttributes> attributes) const {
    const auto valid = [](double v) { return v >= kLeast && v <= kMost && v == std::floor(v); };
    for (std::size_t i = 0; i < points.size(); ++i) {
      const LatticePoint& p = points[i];
      if (!valid(p[0]) || !valid(p[1]) || !valid(p[2])) {
        throw CannotWrite(
            file_->name(),
            fmt::format(
                "point {} ({}, {}, {}) is not on the 32-bit integers that LAS holds; choose "
                "another scale or offset, or write spp",
                written_ + i, p[0], p[1], p[2]),
            ErrorCode::kInvalidArgument, at_record(written_ + i));
      }
      if (!attributes.empty() && !holds(attributes[i])) {
        const PointAttributes& a = attributes[i];
        throw CannotWrite(
            file_->name(),
            fmt::format(
                "point {} (class {}, return {} of {}{}) is more than a LAS {} record holds{}",
                written_ + i, a.classification, a.return_number, a.return_count,
                (a.flags & PointAttributes::kOverlap) != 0 ? ", overlap" : "",
                version14_ ? "1.4" : "1.2", version14_ ? "; the input is corrupt" : ""),
            version14_ ? ErrorCode::kBadInput : ErrorCode::kInvalidArgument,
            at_record(written_ + i), version14_ ? Remedy::kNone : Remedy::kLas14);
      }
    }
    throw std::logic_error("a block without invalid points was called invalid");
  }

  /// The public header block. `bounds` is of integers.
  [[nodiscard]] std::vector<std::byte> header(std::uint64_t count, const Box<3>& bounds,
                                              const ReturnCounts& returns) const {
    const std::size_t size = version14_ ? kLas14HeaderSize : kLasHeaderSize;
    std::vector<std::byte> bytes(size);
    const auto put_text = [&](std::size_t at, std::string_view text) {
      std::memcpy(&bytes[at], text.data(), text.size());
    };
    put_text(las_field::kSignature, "LASF");
    store(&bytes[las_field::kGlobalEncoding], crs_.wkt_bit ? kLasWktBit : std::uint16_t{0});
    store(&bytes[las_field::kVersionMajor], std::uint8_t{1});
    store(&bytes[las_field::kVersionMinor], std::uint8_t(version14_ ? 4 : 2));
    put_text(las_field::kSystemIdentifier, "generated");
    put_text(las_field::kSoftware, "Spillway");
    store(&bytes[las_field::kHeaderSize], static_cast<std::uint16_t>(size));
    store(&bytes[las_field::kOffsetToPoints], static_cast<std::uint32_t>(size + crs_.bytes.size()));
    store(&bytes[las_field::kVlrCount], crs_.records);
    store(&bytes[las_field::kPointFormat], std::uint8_t(version14_ ? 6 : 0));
    store(&bytes[las_field::kRecordLength], static_cast<std::uint16_t>(record_length_));
    if (version14_) {
      store(&bytes[las_field::kCount], count);
      std::memcpy(&bytes[las_field::kByReturn], &returns[1], kReturns * sizeof(std::uint64_t));
    } else {
      store(&bytes[las_field::kLegacyCount], static_cast<std::uint32_t>(count));
      for (std::size_t i = 0; i < kLegacyReturns; ++i) {
        store(&bytes[las_field::kLegacyByReturn + i * sizeof(std::uint32_t)],
              static_cast<std::uint32_t>(returns[i + 1]));
      }
    }
    store(&bytes[las_field::kScale], lattice_.scale);
    store(&bytes[las_field::kOffset], lattice_.offset);
    std::byte* at = &bytes[las_field::kBounds];
    for (int axis = 0; axis < 3; ++axis, at += 2 * sizeof(double)) {
      store(at, lattice_.to_world(axis, bounds.hi[axis]));
      store(at + sizeof(double), lattice_.to_world(axis, bounds.lo[axis]));
    }
    return bytes;
  }

  std::unique_ptr<OutputFile> file_;
  std::optional<std::uint64_t> count_;  // promised
  bool version14_;
  std::size_t record_length_;
  Lattice lattice_;
  LasCrs crs_;
  std::uint64_t written_ = 0;
  Box<3> bounds_;           // of the integers written so far
  ReturnCounts returns_{};  // of the points written so far
  bool invalid_ = false;    // the current block has a point that LAS cannot hold
  std::vector<std::byte> records_;
};

}  // namespace

std::unique_ptr<PointWriter> open_las_writer(std::unique_ptr<OutputFile> file,
                                             const PointWriterOptions& options) {
  return std::make_unique<LasWriter>(std::move(file), options);
}

}  // namespace spillway::detail
