#pragma once

#include <string>
#include <vector>

#include "formats/points/common/point_reader.h"
#include "formats/points/las/records/las_flags.h"

namespace spillway::test {

/// Records like those of a scanner: pulses with returns, channels that take turns, GPS times that
/// run, repeat and jump, and now and then the extremes of each field.
struct RandomRecords {
  int point_format = 0;
  std::size_t extra_bytes = 0;
  std::size_t count = 0;
  unsigned seed = 1;
  /// Only coordinates change.
  bool quiet = false;
  bool flat = false;  ///< z does not change

  [[nodiscard]] std::vector<std::string> make() const;
};

/// The coordinates and attributes that a record means, from the specification of LAS.
LatticePoint point_of_record(const std::string& record);
LasFlags attributes_of_record(int point_format, const std::string& record);

}  // namespace spillway::test
