#include "formats/points/las/las_header.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

#include "formats/bytes/bytes.h"
#include "formats/gdal/crs_text.h"
#include "formats/points/las/geotiff_keys.h"
#include "formats/points/las/uncompressed_points.h"
#include "src/error.h"

namespace spillway::formats {
namespace {

/// The fields that only reading needs.
struct Layout {
  std::size_t header_size;
  std::uint64_t offset_to_points;
  std::uint32_t vlr_count;
  unsigned compression;  ///< the two upper bits of the point format
  std::uint64_t evlr_start;
  std::uint32_t evlr_count;
  std::uint64_t waveform_start;  ///< 0: none
};

constexpr unsigned kNotCompressed = 0;
constexpr unsigned kBeforeLaz = 3;

[[noreturn]] void fail(const InputBytes& source, std::uint64_t byte, const std::string& what) {
  throw BadInput(source.name(), what, at_byte(byte));
}

/// Text up to the first NUL, on one line, without blanks at its end.
std::string clean_text(std::string_view text) {
  std::string result(text.substr(0, text.find('\0')));
  std::replace_if(
      result.begin(), result.end(),
      [](char c) { return static_cast<unsigned char>(c) < ' ' || c == '\x7f'; }, ' ');
  result.erase(result.find_last_not_of(' ') + 1);
  return result;
}

std::vector<std::byte> read_public_header(InputBytes& source) {
  source.check_not_empty();
  std::vector<std::byte> bytes(kLasHeaderSize);
  const std::size_t got = source.read(bytes);
  if (!as_text(std::span(bytes).first(got)).starts_with("LASF")) {
    fail(source, 0, "this is not a LAS file: it does not begin with LASF; name its format");
  }
  if (got < kLasHeaderSize) {
    fail(source, got,
         fmt::format("the file ends at byte {}, within the header of {} bytes; get a "
                     "complete copy",
                     got, kLasHeaderSize));
  }
  const auto header_size = load<std::uint16_t>(&bytes[las_field::kHeaderSize]);
  const auto major = std::to_integer<int>(bytes[las_field::kVersionMajor]);
  const auto minor = std::to_integer<int>(bytes[las_field::kVersionMinor]);
  if (major != 1 || minor > 5) {
    fail(source, las_field::kVersionMajor,
         fmt::format("the header says LAS version {}.{}, but only 1.0 to 1.5 are read; "
                     "convert the file",
                     major, minor));
  }
  const std::size_t least = minor < 4 ? kLasHeaderSize : kLas14HeaderSize;
  if (header_size < least) {
    fail(source, las_field::kHeaderSize,
         fmt::format("the header says it has {} bytes, but LAS 1.{} needs {}; the file is "
                     "corrupt",
                     header_size, minor, least));
  }
  bytes.resize(header_size);
  const std::size_t rest = source.read(std::span(bytes).subspan(kLasHeaderSize));
  if (rest < header_size - kLasHeaderSize) {
    fail(source, source.position(),
         fmt::format("the file ends at byte {}, within the header of {} bytes; get a "
                     "complete copy",
                     source.position(), header_size));
  }
  return bytes;
}

Layout read_layout(std::span<const std::byte> bytes) {
  Layout layout{};
  layout.header_size = bytes.size();
  layout.offset_to_points = load<std::uint32_t>(&bytes[las_field::kOffsetToPoints]);
  layout.vlr_count = load<std::uint32_t>(&bytes[las_field::kVlrCount]);
  layout.compression = std::to_integer<unsigned>(bytes[las_field::kPointFormat]) >> 6U;
  if (std::to_integer<int>(bytes[las_field::kVersionMinor]) >= 4) {
    layout.evlr_start = load<std::uint64_t>(&bytes[las_field::kEvlrStart]);
    layout.evlr_count = load<std::uint32_t>(&bytes[las_field::kEvlrCount]);
  }
  constexpr std::size_t kWaveformEnd = las_field::kWaveformStart + sizeof(std::uint64_t);
  if (std::to_integer<int>(bytes[las_field::kVersionMinor]) >= 3 && bytes.size() >= kWaveformEnd) {
    layout.waveform_start = load<std::uint64_t>(&bytes[las_field::kWaveformStart]);
  }
  return layout;
}

void check_point_format(const InputBytes& source, unsigned format, std::size_t record_length) {
  if (format >= kLasRecordLengths.size()) {
    fail(source, las_field::kPointFormat,
         fmt::format("the header says point format {}, but only 0 to 10 exist; the file is "
                     "corrupt",
                     format));
  }
  if (record_length < kLasRecordLengths[format]) {
    fail(source, las_field::kRecordLength,
         fmt::format("the header says point records of {} bytes, but format {} needs {}; "
                     "the file is corrupt",
                     record_length, format, kLasRecordLengths[format]));
  }
}

std::uint64_t point_count(const InputBytes& source, std::span<const std::byte> bytes,
                          int point_format) {
  const std::uint64_t legacy = load<std::uint32_t>(&bytes[las_field::kLegacyCount]);
  if (std::to_integer<int>(bytes[las_field::kVersionMinor]) < 4) return legacy;
  const auto count = load<std::uint64_t>(&bytes[las_field::kCount]);
  if (count == 0) return legacy;
  if (point_format < 6 && legacy != 0 && legacy != count) {
    fail(source, las_field::kCount,
         fmt::format("the header gives two numbers of points, {} and {}; the file is "
                     "corrupt",
                     legacy, count));
  }
  return count;
}

IntegerLattice read_lattice(const InputBytes& source, std::span<const std::byte> bytes) {
  constexpr double kLargest = 2147483648.0;
  IntegerLattice lattice;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto scale = load<double>(&bytes[las_field::kScale + axis * sizeof(double)]);
    const auto offset = load<double>(&bytes[las_field::kOffset + axis * sizeof(double)]);
    if (!(scale > 0) || !std::isfinite(kLargest * scale + std::abs(offset))) {
      fail(source, las_field::kScale + axis * sizeof(double),
           fmt::format("the header has scale {} and offset {} for {}, but a scale is a "
                       "positive number and an offset a finite one; the file is corrupt",
                       scale, offset, "xyz"[axis]));
    }
    lattice.scale[axis] = scale;
    lattice.offset[axis] = offset;
  }
  return lattice;
}

Box<3> read_extent(std::span<const std::byte> bytes) {
  Box<3> extent;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const std::byte* bounds = &bytes[las_field::kBounds + axis * 2 * sizeof(double)];
    extent.hi[axis] = load<double>(bounds);
    extent.lo[axis] = load<double>(bounds + sizeof(double));
    const double length = extent.hi[axis] - extent.lo[axis];
    if (!(length >= 0 && std::isfinite(length))) return {};
  }
  return extent;
}

/// What variable length records say of the coordinate system, before the points or after them.
class CrsRecords {
 public:
  static bool tells_crs(std::string_view user, std::uint16_t record) {
    return user == kLasCrsUser &&
           (record == kLasWktRecord || record == kLasGeotiffRecord ||
            record == kLasGeotiffNumberRecord || record == kLasGeotiffTextRecord);
  }

  /// Keeps what a record tells that tells_crs().
  void take(std::uint16_t record, std::span<const std::byte> content) {
    if (record == kLasWktRecord) wkt_ = clean_text(as_text(content));
    if (record == kLasGeotiffRecord) keys_.directory.assign(content.begin(), content.end());
    if (record == kLasGeotiffNumberRecord) keys_.numbers.assign(content.begin(), content.end());
    if (record == kLasGeotiffTextRecord) keys_.text = as_text(content);
  }

  /// Puts what they tell into the header: WKT before keys, unless it plainly is none.
  void tell(LasHeader& header) const {
    if (looks_like_crs(wkt_)) {
      header.crs = wkt_;
      header.crs_note.clear();
      header.crs_keys = keys_;
      return;
    }
    if (wkt_.empty() && keys_.empty()) return;
    GeotiffCrs told = keys_.empty() ? GeotiffCrs{} : read_geotiff_keys(keys_);
    header.crs = std::move(told.crs);
    header.crs_note = std::move(told.note);
    if (told.has_more) header.crs_keys = keys_;
    if (wkt_.empty()) return;
    header.crs_note = unreadable_crs(
        wkt_, header.crs.empty() ? header.crs_note : "its GeoTIFF keys are taken instead");
  }

 private:
  std::string wkt_;
  GeotiffKeys keys_;
};

/// A record by its header, which begins alike before the points and behind them.
LasVlr vlr_of(std::span<const std::byte> header, std::span<const std::byte> content,
              bool extended) {
  const std::size_t description = extended ? 28 : 22;
  return {.reserved = load<std::uint16_t>(header.data()),
          .user = clean_text(as_text(header.subspan(2, 16))),
          .id = load<std::uint16_t>(&header[18]),
          .description = clean_text(as_text(header.subspan(description, 32))),
          .content = std::string(as_text(content)),
          .extended = extended};
}

/// Whether a record tells how the points of this file lie in it.
bool tells_structure(const LasVlr& record) {
  return (record.user == kLazUser && record.id == kLazRecordId) || record.user == kCopcUser;
}

/// Reads the variable length records before the points into `header`: those that the file counts,
/// up to the first that does not end before the points; all but those of the structure into
/// `metadata`, too, if that is wanted. Returns how many these are.
std::uint32_t read_vlrs(InputBytes& source, const Layout& layout, LasHeader& header,
                        LasMetadata* metadata) {
  CrsRecords records;
  std::array<std::byte, kLasVlrHeaderSize> start_of_record;
  std::vector<std::byte> content;
  const auto read_part = [&](std::span<std::byte> part) {
    return source.position() + part.size() <= layout.offset_to_points &&
           source.read(part) == part.size();
  };
  std::uint32_t count = 0;
  for (; count < layout.vlr_count; ++count) {
    const std::uint64_t start = source.position();
    if (!read_part(start_of_record)) break;
    const std::string user = clean_text(as_text(std::span(start_of_record).subspan(2, 16)));
    const auto record = load<std::uint16_t>(&start_of_record[18]);
    content.resize(load<std::uint16_t>(&start_of_record[20]));
    if (!read_part(content)) break;
    if (CrsRecords::tells_crs(user, record)) records.take(record, content);
    if (user == kLasSpecUser && record == kLasExtraBytesRecord) {
      const std::size_t at = kLasRecordLengths.at(header.point_format);
      header.extra_fields = las_extra_fields(content, at, header.record_length - at);
    }
    if (metadata != nullptr) {
      LasVlr vlr = vlr_of(start_of_record, content, false);
      if (!tells_structure(vlr)) metadata->records.push_back(std::move(vlr));
    }
    if (count == 0 && user == kCopcUser && record == kCopcInfoId) {
      header.copc = parse_copc_info(content);
    }
    if (user == kLazUser && record == kLazRecordId) {
      if (header.laz) fail(source, start, "there are two LAZ records; the file is corrupt");
      header.laz = parse_laz_record(content, header.point_format, header.record_length,
                                    {source.name(), at_byte(start)});
    }
  }
  records.tell(header);
  return count;
}

/// Says that the header counts more records before the points than lie there. They are of no use
/// for finding the points.
void tell_of_missing_vlrs(const Layout& layout, std::uint32_t found, LasHeader& header) {
  if (found == layout.vlr_count) return;
  header.notices.push_back(fmt::format(
      "the header counts {} variable length record{}, but {} lie{} before the points, which begin "
      "at byte {}; the points are read; write the file again, or correct the count in the header "
      "(4 bytes from byte {} on)",
      layout.vlr_count, layout.vlr_count == 1 ? "" : "s",
      found == 0 ? "none" : fmt::format("only {}", found), found > 1 ? "" : "s",
      layout.offset_to_points, las_field::kVlrCount));
}

/// Puts the coordinate system that the records after the points tell into the header, if none was
/// told before them, and all records into `metadata`, if that is wanted. What is damaged there ends
/// the search, as the points can be read without. Returns whether all records that were looked for
/// lie within the file.
bool read_evlrs(InputBytes& source, const Layout& layout, LasHeader& las, LasMetadata* metadata) {
  constexpr std::uint32_t kMostRecords = 1000;
  constexpr std::uint64_t kLongest = std::uint64_t{1} << 20;
  constexpr std::uint64_t kLongestKept = std::uint64_t{16} << 20;
  const std::optional<std::uint64_t> size = source.size();
  if (!size) return true;
  const std::uint64_t back = source.position();
  const std::uint32_t most = std::min(layout.evlr_count, kMostRecords);
  CrsRecords records;
  std::array<std::byte, kLasEvlrHeaderSize> header;
  std::vector<std::byte> content;
  std::uint64_t at = layout.evlr_start;
  std::uint32_t found = 0;
  for (; found < most; ++found) {
    if (at < layout.offset_to_points || at > *size || *size - at < header.size()) break;
    if (!source.seek(at) || source.read(header) < header.size()) break;
    at += header.size();
    const auto length = load<std::uint64_t>(&header[20]);
    if (length > *size - at) break;
    LasVlr vlr = vlr_of(header, {}, true);
    const bool tells_crs = CrsRecords::tells_crs(vlr.user, vlr.id) && length <= kLongest;
    const bool kept = metadata != nullptr && !tells_structure(vlr);
    if (tells_crs || (kept && length <= kLongestKept)) {
      content.resize(length);
      if (source.read(content) < length) break;
    }
    if (tells_crs) records.take(vlr.id, content);
    if (kept && length > kLongestKept) {
      metadata->left_out.push_back(vlr.name());
    } else if (kept) {
      vlr.content = std::string(as_text(content));
      metadata->records.push_back(std::move(vlr));
    }
    at += length;
  }
  if (source.position() != back) source.seek(back);
  if (las.crs.empty()) records.tell(las);
  return found == most;
}

/// Whether there is room for the headers of the records after the points that the file counts.
bool evlr_headers_fit(const InputBytes& source, const Layout& layout) {
  const std::optional<std::uint64_t> size = source.size();
  if (!size) return true;
  return layout.evlr_start >= layout.offset_to_points && layout.evlr_start <= *size &&
         layout.evlr_count <= (*size - layout.evlr_start) / kLasEvlrHeaderSize;
}

/// Looks at the records after the points, for the coordinate system if none was told before them,
/// and says if they are not all there.
void look_at_evlrs(InputBytes& source, const Layout& layout, LasHeader& header,
                   LasMetadata* metadata) {
  if (layout.evlr_count == 0) return;
  if (metadata != nullptr && !source.size()) {
    metadata->left_out.emplace_back("records behind the points, which a pipe tells too late");
  }
  bool complete = evlr_headers_fit(source, layout);
  if (header.crs.empty() || metadata != nullptr) {
    complete = read_evlrs(source, layout, header, metadata) && complete;
  }
  if (complete) return;
  header.notices.push_back(fmt::format(
      "the header counts {} extended variable length record{} from byte {} on, but not all of "
      "that lies between the points and the end of the file at byte {}; the points are read; get "
      "a complete copy, or correct the count in the header (4 bytes from byte {} on)",
      layout.evlr_count, layout.evlr_count == 1 ? "" : "s", layout.evlr_start,
      source.size().value_or(0), las_field::kEvlrCount));
}

/// What begins first after the points; nothing that would begin before them.
std::optional<std::uint64_t> offset_behind_points(const Layout& layout, int point_format) {
  const bool waveforms = point_format == 4 || point_format == 5 || point_format >= 9;
  std::optional<std::uint64_t> offset;
  for (const std::uint64_t start :
       {layout.evlr_count > 0 ? layout.evlr_start : 0, waveforms ? layout.waveform_start : 0}) {
    if (start > layout.offset_to_points && (!offset || start < *offset)) offset = start;
  }
  return offset;
}

/// Checks that the file can hold the records before any of them is read.
void check_layout(const InputBytes& source, const Layout& layout) {
  if (layout.offset_to_points < layout.header_size) {
    fail(source, las_field::kOffsetToPoints,
         fmt::format("the header says the points begin at byte {}, within the header of {} "
                     "bytes; the file is corrupt",
                     layout.offset_to_points, layout.header_size));
  }
  const std::optional<std::uint64_t> size = source.size();
  if (size && layout.offset_to_points > *size) {
    fail(source, las_field::kOffsetToPoints,
         fmt::format("the header says the points begin at byte {}, but the file ends at "
                     "byte {}; get a complete copy",
                     layout.offset_to_points, *size));
  }
}

/// Makes the flag bits of the point format and the LAZ record agree.
void check_compression(const InputBytes& source, const Layout& layout, LasHeader& header) {
  if (layout.compression == kBeforeLaz) {
    fail(source, las_field::kPointFormat,
         "the points are compressed in the way before LAZ, which is not read; convert the "
         "file with the program that wrote it");
  }
  if (layout.compression != kNotCompressed && !header.laz) {
    fail(source, las_field::kPointFormat,
         "the points are said to be compressed (LAZ), but there is no record that says how; "
         "the file is corrupt");
  }
  if (header.laz && header.laz->compressor == LazCompressor::kNone) header.laz.reset();
  if (!header.laz || !header.laz->format.layered) header.copc.reset();
}

/// What only a file that is made of this one asks for; the records are still to come.
std::shared_ptr<LasMetadata> metadata_of(std::span<const std::byte> bytes,
                                         const LasHeader& header) {
  auto metadata = std::make_shared<LasMetadata>();
  metadata->version = header.version;
  metadata->point_format = header.point_format;
  metadata->file_source = load<std::uint16_t>(&bytes[las_field::kFileSource]);
  metadata->encoding = load<std::uint16_t>(&bytes[las_field::kGlobalEncoding]);
  std::ranges::copy(bytes.subspan(las_field::kProject, metadata->project.size()),
                    metadata->project.begin());
  metadata->system =
      clean_text(as_text(bytes.subspan(las_field::kSystemIdentifier, kLasTextField)));
  metadata->day = load<std::uint16_t>(&bytes[las_field::kCreationDay]);
  metadata->year = load<std::uint16_t>(&bytes[las_field::kCreationYear]);
  return metadata;
}

/// LAS 1.3 has one record behind the points, which holds waveforms.
void keep_waveforms_of_13(InputBytes& source, const Layout& layout, LasHeader& header,
                          LasMetadata& metadata) {
  if (header.version != "1.3" || layout.waveform_start <= layout.offset_to_points) return;
  Layout waveforms = layout;
  waveforms.evlr_start = layout.waveform_start;
  waveforms.evlr_count = 1;
  const bool found = source.size() && read_evlrs(source, waveforms, header, &metadata);
  if (!found) metadata.left_out.emplace_back("waveforms");
}

/// Extra bytes that no record tells of are a field, too.
void complete_extra_fields(LasHeader& header) {
  const std::size_t at = kLasRecordLengths.at(header.point_format);
  if (!header.extra_fields.empty() || header.record_length == at) return;
  header.extra_fields = las_extra_fields({}, at, header.record_length - at);
}

}  // namespace

std::vector<AttributeField> LasHeader::fields() const {
  std::vector<AttributeField> all = las_fields(point_format);
  all.insert(all.end(), extra_fields.begin(), extra_fields.end());
  return all;
}

LasHeader read_las_header(InputBytes& source, const LasHeaderOptions& options) {
  constexpr unsigned kFormatBits = 0x3f;
  const std::vector<std::byte> bytes = read_public_header(source);
  const Layout layout = read_layout(bytes);
  LasHeader header;
  header.version = fmt::format("1.{}", std::to_integer<int>(bytes[las_field::kVersionMinor]));
  header.record_length = load<std::uint16_t>(&bytes[las_field::kRecordLength]);
  header.offset_to_points = layout.offset_to_points;
  const auto format = std::to_integer<unsigned>(bytes[las_field::kPointFormat]) & kFormatBits;
  check_point_format(source, format, header.record_length);
  header.point_format = static_cast<int>(format);
  header.offset_behind_points = offset_behind_points(layout, header.point_format);
  header.count = point_count(source, bytes, header.point_format);
  header.lattice = read_lattice(source, bytes);
  header.extent = read_extent(bytes);
  header.software =
      clean_text(as_text(std::span(bytes).subspan(las_field::kSoftware, kLasTextField)));
  check_layout(source, layout);
  const std::shared_ptr<LasMetadata> kept = options.metadata ? metadata_of(bytes, header) : nullptr;
  const std::uint32_t vlrs = read_vlrs(source, layout, header, kept.get());
  complete_extra_fields(header);
  tell_of_missing_vlrs(layout, vlrs, header);
  check_compression(source, layout, header);
  look_at_evlrs(source, layout, header, kept.get());
  if (kept) keep_waveforms_of_13(source, layout, header, *kept);
  header.metadata = kept;
  if (!source.skip(layout.offset_to_points - source.position())) {
    fail(source, source.position(),
         fmt::format("the file ends at byte {}, before the points; get a complete copy",
                     source.position()));
  }
  if (!header.laz) {
    const bool all_vlrs = vlrs == layout.vlr_count;
    find_points(source, header,
                {.salvage = options.salvage,
                 .doubt = all_vlrs ? ""
                                   : fmt::format(", and its {} variable length records do not fit "
                                                 "before them, either",
                                                 layout.vlr_count)});
  }
  return header;
}

PointHeader las_point_header(const LasHeader& las, const std::string& path) {
  PointHeader header;
  header.name = path;
  header.format = las.copc ? "copc" : las.laz ? "laz" : "las";
  header.version = las.version;
  header.point_format = las.point_format;
  header.count = las.count;
  header.lost = las.lost;
  header.lattice = las.lattice;
  if (!las.extent.empty()) header.extent = las.extent;
  header.crs = las.crs;
  header.crs_note = las.crs_note;
  header.crs_keys = las.crs_keys;
  header.software = las.software;
  header.notices = las.notices;
  header.attributes = las_layout(las.point_format, las.extra_fields);
  header.las_metadata = las.metadata;
  return header;
}

}  // namespace spillway::formats
