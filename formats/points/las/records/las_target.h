#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "formats/points/common/point_writer.h"
#include "formats/points/las/records/las_fields.h"

namespace spillway::formats {

/// Which LAS may be written.
enum class LasProfile {
  kAny,
  kCopc,  ///< LAS 1.4, point formats 6 to 8, no waveforms, WKT
};

/// Whether the attribute is one of a wave packet, of which COPC holds none.
bool tells_waveform(std::string_view attribute);

/// Which LAS is written.
struct LasTarget {
  int minor_version = 2;  ///< of 1.2, 1.3 or 1.4
  int point_format = 0;
  std::vector<AttributeField> extra{};  ///< for attributes that the point format does not have

  /// Whether records have the 30 bytes of LAS 1.4.
  [[nodiscard]] bool extended() const { return point_format >= 6; }
  [[nodiscard]] std::size_t record_length() const;
  /// All fields of a record.
  [[nodiscard]] std::vector<AttributeField> fields() const;
};

/// What holds the points that the options tell of: the point format of the inputs if all have one
/// and the version allows it, else the least with all attributes; version 1.2 or 1.3, and 1.4 where
/// inputs or the number of points need it, or the version is given. Without attributes, point
/// format 0 or 6. Throws Failure, which names `file`, if there is none.
LasTarget las_target(const std::string& file, const PointWriterOptions& options,
                     LasProfile profile = LasProfile::kAny);

}  // namespace spillway::formats
