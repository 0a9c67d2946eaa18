#include "formats/points/las/las_content.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <stdexcept>
#include <string_view>
#include <utility>

#include "formats/bytes/bytes.h"
#include "formats/points/las/las_header.h"
#include "src/error.h"

namespace spillway::detail {
namespace {

constexpr double kLeast = std::numeric_limits<std::int32_t>::min();
constexpr double kMost = std::numeric_limits<std::int32_t>::max();
constexpr std::uint64_t kMostLegacyPoints = std::numeric_limits<std::uint32_t>::max();
constexpr std::size_t kLegacyReturns = 5;   // that a header counts
constexpr std::uint8_t kCompressed = 0x80;  // in the byte of the point format
constexpr PointAttributes kSingleReturn{.return_number = 1, .return_count = 1};

/// Whether the file is LAS 1.4 with point format 6, not 1.2 with point format 0.
bool is_version14(const std::string& file, const PointWriterOptions& options) {
  const bool large = options.count && *options.count > kMostLegacyPoints;
  if (options.version.empty()) return large;
  if (options.version != "1.2" && options.version != "1.4") {
    throw InvalidArgument(fmt::format("cannot write {}: LAS {} is not written; choose 1.2 or 1.4",
                                      file, options.version),
                          {.file = file});
  }
  if (options.version == "1.2" && large) {
    throw InvalidArgument(
        fmt::format("cannot write {}: {} points are more than LAS 1.2 counts; choose "
                    "1.4",
                    file, *options.count),
        {.file = file});
  }
  return options.version == "1.4";
}

}  // namespace

LasContent::LasContent(std::string file_name, const PointWriterOptions& options)
    : file_name_(std::move(file_name)),
      promised_(options.count),
      attributes_come_(options.attributes),
      version14_(is_version14(file_name_, options)),
      record_length_(kLasRecordLengths[version14_ ? 6 : 0]) {
  if (!options.lattice) {
    throw CannotWrite(file_name_,
                      "LAS holds integers with a scale, and these points have none; write spp, "
                      "npy or text, or round them with convert");
  }
  if (options.coordinates != 3) {
    throw CannotWrite(file_name_, "LAS points have three coordinates; write text or npy");
  }
  lattice_ = *options.lattice;
  try {
    crs_ = las_crs(options.crs, options.crs_wkt, version14_);
  } catch (const Error& error) {
    throw CannotWrite(file_name_, error.what(), error.code());
  }
}

void LasContent::compress(const LazRecord& laz) {
  const std::vector<std::byte> content = laz_record_bytes(laz);
  laz_.assign(kLasVlrHeaderSize, std::byte{0});
  std::ranges::copy(as_bytes_of(kLazUser), laz_.begin() + 2);
  store(&laz_[18], kLazRecordId);
  store(&laz_[20], static_cast<std::uint16_t>(content.size()));
  laz_.insert(laz_.end(), content.begin(), content.end());
}

std::vector<std::byte> LasContent::head() const {
  ReturnCounts returns{};
  if (!attributes_come_) returns[1] = promised_.value_or(0);
  std::vector<std::byte> head =
      header(promised_.value_or(0), {{kLeast, kLeast, kLeast}, {kMost, kMost, kMost}}, returns);
  head.insert(head.end(), crs_.bytes.begin(), crs_.bytes.end());
  head.insert(head.end(), laz_.begin(), laz_.end());
  return head;
}

std::vector<std::byte> LasContent::final_header() const {
  return header(count_, count_ > 0 ? bounds_ : Box<3>{{0, 0, 0}, {0, 0, 0}}, returns_);
}

void LasContent::append_records(std::span<const LatticePoint> points,
                                std::span<const PointAttributes> attributes,
                                std::vector<std::byte>& out) {
  if (!version14_ && count_ + points.size() > kMostLegacyPoints) {
    throw CannotWrite(
        file_name_,
        fmt::format("more than {} points come, and LAS 1.2 counts no further", kMostLegacyPoints),
        ErrorCode::kTooLarge, at_record(kMostLegacyPoints), Remedy::kLas14);
  }
  const std::size_t before = out.size();
  out.resize(before + points.size() * record_length_);
  std::byte* record = out.data() + before;
  for (std::size_t i = 0; i < points.size(); ++i, record += record_length_) {
    bounds_.expand(points[i]);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      store(record + 4 * axis, to_int32(points[i][axis]));
    }
    put_attributes(record, attributes.empty() ? kSingleReturn : attributes[i]);
  }
  if (invalid_) fail_at_first_invalid(points, attributes);
  count_ += points.size();
}

/// Remembers in invalid_ if the value is no 32-bit integer.
std::int32_t LasContent::to_int32(double value) {
  const bool in_range = value >= kLeast && value <= kMost;
  const auto integer = static_cast<std::int32_t>(in_range ? value : 0.0);
  invalid_ |= static_cast<double>(integer) != value;
  return integer;
}

/// Whether a record has the bits for them.
bool LasContent::holds(const PointAttributes& a) const {
  if (version14_) return a.return_number <= kReturns && a.return_count <= kReturns;
  return a.return_number <= 7 && a.return_count <= 7 && a.classification <= 31 &&
         (a.flags & PointAttributes::kOverlap) == 0;
}

/// Bytes 14 to 16 of a record: docs/formats-points.md ("LAS, written"). All others stay 0.
void LasContent::put_attributes(std::byte* record, const PointAttributes& a) {
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

void LasContent::fail_at_first_invalid(std::span<const LatticePoint> points,
                                       std::span<const PointAttributes> attributes) const {
  const auto valid = [](double v) { return v >= kLeast && v <= kMost && v == std::floor(v); };
  for (std::size_t i = 0; i < points.size(); ++i) {
    const LatticePoint& p = points[i];
    if (!valid(p[0]) || !valid(p[1]) || !valid(p[2])) {
      throw CannotWrite(
          file_name_,
          fmt::format("point {} ({}, {}, {}) is not on the 32-bit integers that LAS holds; choose "
                      "another scale or offset, or write spp",
                      count_ + i, p[0], p[1], p[2]),
          ErrorCode::kInvalidArgument, at_record(count_ + i));
    }
    if (!attributes.empty() && !holds(attributes[i])) {
      const PointAttributes& a = attributes[i];
      throw CannotWrite(
          file_name_,
          fmt::format("point {} (class {}, return {} of {}{}) is more than a LAS {} record holds{}",
                      count_ + i, a.classification, a.return_number, a.return_count,
                      (a.flags & PointAttributes::kOverlap) != 0 ? ", overlap" : "",
                      version14_ ? "1.4" : "1.2", version14_ ? "; the input is corrupt" : ""),
          version14_ ? ErrorCode::kBadInput : ErrorCode::kInvalidArgument, at_record(count_ + i),
          version14_ ? Remedy::kNone : Remedy::kLas14);
    }
  }
  throw std::logic_error("a block without invalid points was called invalid");
}

/// The public header block. `bounds` is of integers.
std::vector<std::byte> LasContent::header(std::uint64_t count, const Box<3>& bounds,
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
  store(&bytes[las_field::kOffsetToPoints],
        static_cast<std::uint32_t>(size + crs_.bytes.size() + laz_.size()));
  store(&bytes[las_field::kVlrCount], crs_.records + (laz_.empty() ? 0U : 1U));
  store(&bytes[las_field::kPointFormat],
        static_cast<std::uint8_t>(point_format() | (laz_.empty() ? 0 : kCompressed)));
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

}  // namespace spillway::detail
