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
#include "formats/points/las/records/vlr_bytes.h"
#include "src/error.h"

namespace spillway::formats {
namespace {

constexpr double kLeast = std::numeric_limits<std::int32_t>::min();
constexpr double kMost = std::numeric_limits<std::int32_t>::max();
constexpr std::uint64_t kMostLegacyPoints = std::numeric_limits<std::uint32_t>::max();
constexpr std::size_t kLegacyReturns = 5;   // that a header counts
constexpr std::uint8_t kCompressed = 0x80;  // in the byte of the point format
constexpr std::size_t kReturnsByte = 14;

/// Records that follow from what is written, and not from the inputs.
bool is_made_anew(const LasVlr& record, bool keeps_crs) {
  return record.tells_extra_bytes() || (record.tells_crs() && !keeps_crs);
}

/// Whether the coordinate system may stay in the records of the inputs: point formats from 6 on
/// have WKT, and others mostly keys.
bool keeps_crs(const PointWriterOptions& options, const LasTarget& target) {
  return options.keeps_crs_records && options.las != nullptr && options.las->point_format >= 0 &&
         (options.las->point_format >= 6) == target.extended();
}

/// The bytes that the input's record of extra bytes has.
std::span<const std::byte> extra_bytes_of(const LasMetadata& las) {
  const auto record = std::ranges::find_if(las.records, &LasVlr::tells_extra_bytes);
  if (record == las.records.end()) return {};
  return as_bytes_of(record->content);
}

}  // namespace

LasContent::LasContent(std::string file_name, const PointWriterOptions& options, LasProfile profile)
    : file_name_(std::move(file_name)),
      promised_(options.count),
      target_(las_target(file_name_, options, profile)),
      record_length_(target_.record_length()),
      attributes_(options.attributes),
      packing_(attributes_.fields(), target_.fields()),
      first_record_(record_length_) {
  if (!options.lattice) {
    throw CannotWrite(file_name_,
                      "LAS holds integers with a scale, and these points have none; write spp, "
                      "npy or text, or round them with convert");
  }
  if (options.coordinates != 3) {
    throw CannotWrite(file_name_, "LAS points have three coordinates; write text or npy");
  }
  lattice_ = *options.lattice;
  if (attributes_.find("return_number") == nullptr) {  // then all are single returns
    first_record_[kReturnsByte] = static_cast<std::byte>(target_.extended() ? 0x11 : 0x09);
  }
  if (options.las) las_ = *options.las;
  const bool old_crs = keeps_crs(options, target_);
  std::erase_if(las_.records, [&](const LasVlr& record) { return is_made_anew(record, old_crs); });
  encoding_ = las_.encoding;
  if (!old_crs) {
    encoding_ &= ~kLasWktBit;
    try {
      const LasCrs crs = las_crs(options.crs, options.crs_wkt, target_.extended());
      vlrs_ = crs.bytes;
      vlr_count_ = crs.records;
      if (crs.wkt_bit) encoding_ |= kLasWktBit;
    } catch (const Failure& error) {
      throw CannotWrite(file_name_, error.what(), error.code());
    }
  }
  if (profile == LasProfile::kCopc) {
    leave_out_waveforms();
    encoding_ |= kLasWktBit;
  }
  keep_what_version_holds();
  const auto add = [this](const LasVlr& record) {
    append_vlr(record, vlrs_);
    ++vlr_count_;
  };
  if (!target_.extra.empty()) {
    const std::span<const std::byte> known =
        options.las ? extra_bytes_of(*options.las) : std::span<const std::byte>();
    add({.user = std::string(kLasSpecUser),
         .id = kLasExtraBytesRecord,
         .content = std::string(as_text(las_extra_descriptors(target_.extra, known)))});
  }
  for (const LasVlr& record : las_.records) {
    if (!record.extended) add(record);
  }
  std::erase_if(las_.records, [](const LasVlr& record) { return !record.extended; });
}

/// Before LAS 1.4, waveforms are the one record behind the points, from 1.3 on.
void LasContent::keep_what_version_holds() {
  const auto holds_waveforms = [](const LasVlr& record) {
    return record.user == kLasSpecUser && record.id == kLasWaveformRecord;
  };
  if (std::ranges::none_of(las_.records, holds_waveforms)) encoding_ &= ~kLasWaveformsInBit;
  if (target_.minor_version >= 4) return;
  for (LasVlr& record : las_.records) {
    if (target_.minor_version == 3 && holds_waveforms(record)) continue;
    const std::size_t size = record.content.text().size();
    if (size > std::numeric_limits<std::uint16_t>::max()) {
      throw CannotWrite(file_name_,
                        fmt::format("{} takes {} bytes, which LAS holds from version 1.4 on",
                                    record.name(), size),
                        ErrorCode::kInvalidArgument, {}, Remedy::kLas14);
    }
    record.extended = false;
  }
}

void LasContent::leave_out_waveforms() {
  std::erase_if(las_.records, &LasVlr::tells_waveforms);
  encoding_ &= ~(kLasWaveformsInBit | kLasWaveformsOutBit);
}

void LasContent::put_first(const LasVlr& record) {
  append_vlr(record, first_);
  ++vlr_count_;
}

void LasContent::put_behind_points(LasVlr record) {
  record.extended = true;
  las_.records.insert(las_.records.begin(), std::move(record));
}

void LasContent::compress(const LazRecord& laz) {
  append_vlr({.user = std::string(kLazUser),
              .id = kLazRecordId,
              .content = std::string(as_text(laz_record_bytes(laz)))},
             laz_);
}

std::vector<std::byte> LasContent::head() const {
  ReturnCounts returns{};
  if (attributes_.empty()) returns[1] = promised_.value_or(0);
  std::vector<std::byte> head =
      header(promised_.value_or(0), {{kLeast, kLeast, kLeast}, {kMost, kMost, kMost}}, returns);
  head.insert(head.end(), first_.begin(), first_.end());
  head.insert(head.end(), vlrs_.begin(), vlrs_.end());
  head.insert(head.end(), laz_.begin(), laz_.end());
  return head;
}

std::vector<std::byte> LasContent::final_header() const {
  return header(count_, count_ > 0 ? bounds_ : Box<3>{{0, 0, 0}, {0, 0, 0}}, returns_);
}

std::uint64_t LasContent::end_of_records() const { return head().size() + count_ * record_length_; }

std::vector<std::vector<std::byte>> LasContent::extended_records(std::uint64_t begin) {
  std::vector<std::vector<std::byte>> all;
  if (target_.minor_version >= 4) extended_at_ = las_.records.empty() ? 0 : begin;
  for (const LasVlr& record : las_.records) {
    if (record.user == kLasSpecUser && record.id == kLasWaveformRecord) waveforms_at_ = begin;
    std::vector<std::byte>& bytes = all.emplace_back();
    append_vlr(record, bytes);
    begin += bytes.size();
  }
  extended_count_ = static_cast<std::uint32_t>(all.size());
  return all;
}

void LasContent::append_records(std::span<const LatticePoint> points,
                                std::span<const std::byte> attributes,
                                std::vector<std::byte>& out) {
  if (!counts_with_64_bits() && count_ + points.size() > kMostLegacyPoints) {
    throw CannotWrite(file_name_,
                      fmt::format("more than {} points come, and LAS 1.{} counts no further",
                                  kMostLegacyPoints, target_.minor_version),
                      ErrorCode::kTooLarge, at_record(kMostLegacyPoints), Remedy::kLas14);
  }
  const std::size_t before = out.size();
  out.resize(before + points.size() * record_length_);
  std::byte* const records = out.data() + before;
  if (first_record_[kReturnsByte] != std::byte{}) {
    for (std::size_t i = 0; i < points.size(); ++i) {
      records[i * record_length_ + kReturnsByte] = first_record_[kReturnsByte];
    }
  }
  put_coordinates(points, records);
  if (!attributes.empty()) put_attributes(attributes, points.size(), records);
  count_returns(records, points.size());
  count_ += points.size();
}

void LasContent::put_coordinates(std::span<const LatticePoint> points, std::byte* records) {
  bool valid = true;
  for (std::size_t i = 0; i < points.size(); ++i) {
    bounds_.expand(points[i]);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double value = points[i][axis];
      const bool in_range = value >= kLeast && value <= kMost;
      const auto integer = static_cast<std::int32_t>(in_range ? value : 0.0);
      valid &= static_cast<double>(integer) == value;
      store(records + i * record_length_ + sizeof(integer) * axis, integer);
    }
  }
  if (!valid) fail_at_first_invalid(points);
}

void LasContent::put_attributes(std::span<const std::byte> attributes, std::size_t count,
                                std::byte* records) const {
  const auto misfit = packing_.convert(attributes.data(), attributes_.record_size(), records,
                                       record_length_, count);
  if (!misfit) return;
  const bool more_in_14 = misfit->to.packed && !target_.extended();
  throw CannotWrite(
      file_name_,
      fmt::format("point {} has {} {}, and records of LAS 1.{}, point format {}, hold {}{}",
                  count_ + misfit->record, misfit->from.attribute.name, misfit->value,
                  target_.minor_version, target_.point_format, range_text(misfit->to),
                  more_in_14 ? "" : "; write spp"),
      ErrorCode::kInvalidArgument, at_record(count_ + misfit->record),
      more_in_14 ? Remedy::kLas14 : Remedy::kAttributes);
}

void LasContent::count_returns(const std::byte* records, std::size_t count) {
  const unsigned mask = target_.extended() ? kReturns : 7;
  for (std::size_t i = 0; i < count; ++i) {
    const std::byte returns = records[i * record_length_ + kReturnsByte];
    ++returns_[std::to_integer<unsigned>(returns) & mask];
  }
}

void LasContent::fail_at_first_invalid(std::span<const LatticePoint> points) const {
  const auto valid = [](double v) { return v >= kLeast && v <= kMost && v == std::floor(v); };
  for (std::size_t i = 0; i < points.size(); ++i) {
    const LatticePoint& p = points[i];
    if (valid(p[0]) && valid(p[1]) && valid(p[2])) continue;
    throw CannotWrite(
        file_name_,
        fmt::format("point {} ({}, {}, {}) is not on the 32-bit integers that LAS holds; choose "
                    "another scale or offset, or write spp",
                    count_ + i, p[0], p[1], p[2]),
        ErrorCode::kInvalidArgument, at_record(count_ + i));
  }
  throw std::logic_error("a block without invalid points was called invalid");
}

/// The public header block. `bounds` is of integers.
std::vector<std::byte> LasContent::header(std::uint64_t count, const Box<3>& bounds,
                                          const ReturnCounts& returns) const {
  const int minor = target_.minor_version;
  const std::size_t size = minor >= 4   ? kLas14HeaderSize
                           : minor == 3 ? kLas13HeaderSize
                                        : kLasHeaderSize;
  std::vector<std::byte> bytes(size);
  const auto put_text = [&](std::size_t at, std::string_view text) {
    std::memcpy(&bytes[at], text.data(), std::min(text.size(), kLasTextField));
  };
  put_text(las_field::kSignature, "LASF");
  store(&bytes[las_field::kFileSource], las_.file_source);
  store(&bytes[las_field::kGlobalEncoding], encoding_);
  store(&bytes[las_field::kProject], las_.project);
  store(&bytes[las_field::kVersionMajor], std::uint8_t{1});
  store(&bytes[las_field::kVersionMinor], static_cast<std::uint8_t>(minor));
  put_text(las_field::kSystemIdentifier, las_.system.empty() ? "generated" : las_.system);
  put_text(las_field::kSoftware, "Spillway");
  store(&bytes[las_field::kCreationDay], las_.day);
  store(&bytes[las_field::kCreationYear], las_.year);
  store(&bytes[las_field::kHeaderSize], static_cast<std::uint16_t>(size));
  store(&bytes[las_field::kOffsetToPoints],
        static_cast<std::uint32_t>(size + first_.size() + vlrs_.size() + laz_.size()));
  store(&bytes[las_field::kVlrCount], vlr_count_ + (laz_.empty() ? 0U : 1U));
  store(&bytes[las_field::kPointFormat],
        static_cast<std::uint8_t>(target_.point_format | (laz_.empty() ? 0 : kCompressed)));
  store(&bytes[las_field::kRecordLength], static_cast<std::uint16_t>(record_length_));
  if (!target_.extended() && count <= kMostLegacyPoints) {
    store(&bytes[las_field::kLegacyCount], static_cast<std::uint32_t>(count));
    for (std::size_t i = 0; i < kLegacyReturns; ++i) {
      store(&bytes[las_field::kLegacyByReturn + i * sizeof(std::uint32_t)],
            static_cast<std::uint32_t>(returns[i + 1]));
    }
  }
  if (minor >= 3) store(&bytes[las_field::kWaveformStart], waveforms_at_);
  if (minor >= 4) {
    store(&bytes[las_field::kEvlrStart], extended_at_);
    store(&bytes[las_field::kEvlrCount], extended_count_);
    store(&bytes[las_field::kCount], count);
    std::memcpy(&bytes[las_field::kByReturn], &returns[1], kReturns * sizeof(std::uint64_t));
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

}  // namespace spillway::formats
