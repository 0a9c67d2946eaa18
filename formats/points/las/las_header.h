#pragma once
// The header of LAS files, as docs/formats-points.md ("LAS") describes it. Source: ASPRS, "LAS
// Specification 1.4 - R15" (2019), tables 3 to 17, and the specifications of 1.0 to 1.3.

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "formats/bytes/input_bytes.h"
#include "formats/points/common/point_reader.h"
#include "formats/points/las/copc_info.h"
#include "formats/points/las/laz_record.h"
#include "formats/points/las/records/las_fields.h"
#include "formats/points/las/records/las_metadata.h"
#include "src/geometry/box.h"
#include "src/geometry/lattice.h"

namespace spillway::formats {

/// Where the fields of the public header block lie.
namespace las_field {
inline constexpr std::size_t kSignature = 0;
inline constexpr std::size_t kFileSource = 4;
inline constexpr std::size_t kGlobalEncoding = 6;
inline constexpr std::size_t kProject = 8;
inline constexpr std::size_t kVersionMajor = 24;
inline constexpr std::size_t kVersionMinor = 25;
inline constexpr std::size_t kSystemIdentifier = 26;
inline constexpr std::size_t kSoftware = 58;
inline constexpr std::size_t kCreationDay = 90;
inline constexpr std::size_t kCreationYear = 92;
inline constexpr std::size_t kHeaderSize = 94;
inline constexpr std::size_t kOffsetToPoints = 96;
inline constexpr std::size_t kVlrCount = 100;
inline constexpr std::size_t kPointFormat = 104;
inline constexpr std::size_t kRecordLength = 105;
inline constexpr std::size_t kLegacyCount = 107;
inline constexpr std::size_t kLegacyByReturn = 111;
inline constexpr std::size_t kScale = 131;
inline constexpr std::size_t kOffset = 155;
inline constexpr std::size_t kBounds = 179;         // max x, min x, max y, min y, max z, min z
inline constexpr std::size_t kWaveformStart = 227;  // from 1.3
inline constexpr std::size_t kEvlrStart = 235;      // from 1.4, like those below
inline constexpr std::size_t kEvlrCount = 243;
inline constexpr std::size_t kCount = 247;
inline constexpr std::size_t kByReturn = 255;
}  // namespace las_field

inline constexpr std::size_t kLasHeaderSize = 227;    ///< of LAS 1.0 to 1.2
inline constexpr std::size_t kLas13HeaderSize = 235;  ///< of LAS 1.3
inline constexpr std::size_t kLas14HeaderSize = 375;  ///< of LAS 1.4
inline constexpr std::size_t kLasTextField = 32;      ///< bytes of an identifier in the header
inline constexpr std::size_t kLasVlrHeaderSize = 54;
inline constexpr std::size_t kLasEvlrHeaderSize = 60;  ///< of the records after the points

/// Records that tell the coordinate system: their user, WKT, and a directory of GeoTIFF keys with
/// the numbers and the text that keys refer to.
inline constexpr std::string_view kLasCrsUser = "LASF_Projection";
inline constexpr std::uint16_t kLasWktRecord = 2112;
inline constexpr std::uint16_t kLasWktMathRecord = 2111;
inline constexpr std::uint16_t kLasGeotiffRecord = 34735;
inline constexpr std::uint16_t kLasGeotiffNumberRecord = 34736;
inline constexpr std::uint16_t kLasGeotiffTextRecord = 34737;

/// Records that tell of extra bytes, that describe and that hold waveforms.
inline constexpr std::string_view kLasSpecUser = "LASF_Spec";
inline constexpr std::uint16_t kLasExtraBytesRecord = 4;
inline constexpr std::uint16_t kLasFirstWaveformDescriptor = 100;
inline constexpr std::uint16_t kLasLastWaveformDescriptor = 354;
inline constexpr std::uint16_t kLasWaveformRecord = 65535;

/// Shortest record of each point format, in bytes; longer ones carry extra bytes at their end.
inline constexpr std::array<std::size_t, 11> kLasRecordLengths = {20, 28, 26, 34, 57, 63,
                                                                  30, 36, 38, 59, 67};

/// In a record: x, y, z as int32, and the byte that holds the withheld flag in every format.
inline constexpr std::size_t kLasFlagByte = 15;

/// The bit of kLasFlagByte that marks a point as withheld.
constexpr unsigned las_withheld_mask(int point_format) { return point_format < 6 ? 0x80 : 0x04; }

/// What a checked header says.
struct LasHeader {
  std::string version;  ///< "1.0" to "1.5"
  int point_format = 0;
  std::size_t record_length = 0;
  std::uint64_t count = 0;  ///< of point records
  IntegerLattice lattice;
  Box<3> extent;                       ///< empty if the header's bounds are not ordered
  std::string crs;                     ///< WKT, or "EPSG:n", or empty
  std::string crs_note;                ///< as PointHeader has it
  GeotiffKeys crs_keys;                ///< likewise
  std::string software;                ///< generating software
  std::vector<std::string> notices;    ///< as PointHeader has them
  std::uint64_t offset_to_points = 0;  ///< compressed or not
  /// Where waveforms or extended records begin after the points, if there are any.
  std::optional<std::uint64_t> offset_behind_points;
  std::optional<LazRecord> laz;                 ///< set if the points are compressed
  std::optional<CopcInfo> copc;                 ///< set if they are and lie in an octree
  std::vector<AttributeField> extra_fields;     ///< of extra bytes
  std::shared_ptr<const LasMetadata> metadata;  ///< set if it was asked for
  std::uint64_t lost = 0;                       ///< as PointHeader has it

  /// What a record has besides coordinates.
  [[nodiscard]] std::vector<AttributeField> fields() const;
};

struct LasHeaderOptions {
  bool salvage =
      false;  ///< `count` is what a file of uncompressed points holds, not what it should
  bool metadata = false;  ///< set LasHeader::metadata
};

/// Reads everything before the first point, and after the points where the coordinate system is
/// not told before, or metadata is wanted, and the source can go there. Throws Failure, before
/// anything is allocated, if a field contradicts another one or the size of the file.
LasHeader read_las_header(InputBytes& source, const LasHeaderOptions& options = {});

/// The same as any point source has it, for a source of that name.
PointHeader las_point_header(const LasHeader& las, const std::string& path);

}  // namespace spillway::formats
