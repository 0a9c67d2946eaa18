#include "stream/source/changed_input.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <system_error>

#include "src/error.h"

namespace spillway::stream {
namespace {

bool same_region(const PointRegion& a, const PointRegion& b) {
  return a.box == b.box && a.count == b.count;
}

/// What of two headers is not the same, in words; empty if all is.
std::string difference(const PointHeader& before, const PointHeader& now) {
  if (before.format != now.format) {
    return fmt::format("the format is {}, not {}", now.format, before.format);
  }
  if (before.version != now.version || before.point_format != now.point_format ||
      before.attributes != now.attributes) {
    return "its records are of another kind";
  }
  if (before.lattice != now.lattice) return "its coordinates have another scale or offset";
  if (before.coordinates != now.coordinates) {
    return fmt::format("its points have {} coordinates, not {}", now.coordinates,
                       before.coordinates);
  }
  if (before.count != now.count) {
    return before.count && now.count
               ? fmt::format("it has {} points, not {}", *now.count, *before.count)
               : "its number of points is told otherwise";
  }
  if (before.crs != now.crs) return "it has another coordinate system";
  if (before.extent != now.extent || before.regions_are_exact != now.regions_are_exact ||
      !std::ranges::equal(before.regions, now.regions, same_region)) {
    return "its points lie elsewhere";
  }
  return "";
}

}  // namespace

std::optional<std::uint64_t> bytes_of_file(const std::string& path) {
  std::error_code unknown;
  const std::uintmax_t bytes = std::filesystem::file_size(path, unknown);
  return unknown ? std::nullopt : std::optional<std::uint64_t>(bytes);
}

void refuse_changed_input(const SourceFacts::Input& surveyed, const std::string& path,
                          const PointReader& opened) {
  std::string what = difference(surveyed.header, opened.header());
  const std::optional<std::uint64_t> bytes = bytes_of_file(path);
  if (what.empty() && surveyed.bytes && bytes && surveyed.bytes != bytes) {
    what = fmt::format("it has {} bytes, not {}", *bytes, *surveyed.bytes);
  }
  if (what.empty()) return;
  throw BadInput(surveyed.header.name,
                 fmt::format("the file has changed since its header was read: {}; run again when "
                             "nothing writes to it",
                             what));
}

}  // namespace spillway::stream
