#include "stream/library/points/lost_fields.h"

#include <algorithm>
#include <initializer_list>

namespace spillway::detail {
namespace {

/// Appends what records of this LAS file have besides what LAS that is written keeps.
void append_las_fields(const PointHeader& header, std::vector<std::string>& fields) {
  const int format = header.point_format;
  const auto is_one_of = [format](std::initializer_list<int> formats) {
    return std::ranges::find(formats, format) != formats.end();
  };
  fields.insert(fields.end(),
                {"intensity", "scan flags", "scan angle", "user data", "point source"});
  if (is_one_of({6, 7, 8, 9, 10})) fields.emplace_back("scanner channel");
  if (!is_one_of({0, 2})) fields.emplace_back("GPS time");
  if (is_one_of({2, 3, 5, 7, 8, 10})) fields.emplace_back("colour");
  if (is_one_of({8, 10})) fields.emplace_back("near infrared");
  if (is_one_of({4, 5, 9, 10})) fields.emplace_back("waveforms");
  if (header.extra_bytes > 0) fields.emplace_back("extra bytes");
}

}  // namespace

std::vector<std::string> lost_fields(const std::vector<PointHeader>& headers,
                                     const PointFormat& format, bool keeps_attributes,
                                     bool has_crs) {
  std::vector<std::string> all;
  for (const PointHeader& header : headers) {
    if (header.point_format < 0) continue;
    if (!keeps_attributes) all.insert(all.end(), {"classes", "returns", "flags"});
    append_las_fields(header, all);
  }
  if (has_crs && !format.holds_crs) all.emplace_back("coordinate system");
  std::vector<std::string> lost;
  for (const std::string& field : all) {
    if (std::ranges::find(lost, field) == lost.end()) lost.push_back(field);
  }
  return lost;
}

}  // namespace spillway::detail
