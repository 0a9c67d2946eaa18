#include "formats/points/attributes/attribute_names.h"

#include <algorithm>
#include <array>

namespace spillway::formats {
namespace {

struct OtherName {
  std::string_view plain;  ///< in lower case, letters and digits alone
  std::string_view name;
};

/// Names that are ours but for case and underscores come first.
constexpr auto kNames = std::to_array<OtherName>({
    {"intensity", "intensity"},
    {"returnnumber", "return_number"},
    {"numberofreturns", "number_of_returns"},
    {"scandirection", "scan_direction"},
    {"edgeofflightline", "edge_of_flight_line"},
    {"classification", "classification"},
    {"synthetic", "synthetic"},
    {"keypoint", "key_point"},
    {"withheld", "withheld"},
    {"overlap", "overlap"},
    {"scannerchannel", "scanner_channel"},
    {"scanangle", "scan_angle"},
    {"userdata", "user_data"},
    {"pointsourceid", "point_source_id"},
    {"gpstime", "gps_time"},
    {"red", "red"},
    {"green", "green"},
    {"blue", "blue"},
    {"nir", "nir"},
    {"i", "intensity"},
    {"returns", "number_of_returns"},
    {"return", "return_number"},
    {"scandirectionflag", "scan_direction"},
    {"edgeofflightlineflag", "edge_of_flight_line"},
    {"class", "classification"},
    {"scanchannel", "scanner_channel"},
    {"scananglerank", "scan_angle"},
    {"pointsource", "point_source_id"},
    {"r", "red"},
    {"g", "green"},
    {"b", "blue"},
    {"infrared", "nir"},
    {"nearinfrared", "nir"},
});

std::string plain_name(std::string_view name) {
  std::string plain;
  for (const char c : name) {
    if (c >= 'A' && c <= 'Z') {
      plain.push_back(static_cast<char>(c - 'A' + 'a'));
    } else if (c != '_' && c != ' ' && c != '-') {
      plain.push_back(c);
    }
  }
  return plain;
}

}  // namespace

std::string attribute_name(std::string_view name) {
  const std::string plain = plain_name(name);
  const auto found = std::ranges::find(kNames, std::string_view(plain), &OtherName::plain);
  return std::string(found == kNames.end() ? name : found->name);
}

}  // namespace spillway::formats
