#include "formats/points/las/uncompressed_points.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <optional>

#include "formats/bytes/bytes.h"
#include "src/error.h"

namespace spillway::formats {
namespace {

/// Records that the file has room for from the first point on.
std::uint64_t room(std::uint64_t size, const LasHeader& header) {
  return (size - std::min(size, header.offset_to_points)) / header.record_length;
}

/// Steps over the two bytes that LAS 1.0 has before the points, if they are there.
void skip_start_signature(InputBytes& source, LasHeader& header) {
  constexpr std::uint16_t kStart = 0xCCDD;
  constexpr std::uint16_t kStartSwapped = 0xDDCC;
  if (header.version != "1.0") return;
  const std::span<const std::byte> begin = source.peek(sizeof(kStart));
  const auto value = begin.size() < sizeof(kStart) ? 0 : load<std::uint16_t>(begin.data());
  if (value != kStart && value != kStartSwapped) return;
  const std::optional<std::uint64_t> size = source.size();
  if (!size) {
    throw BadInput(source.name(),
                   "without the size of the file it is not clear where the points of this LAS 1.0 "
                   "file begin; give it by its name instead of on a pipe",
                   at_byte(header.offset_to_points));
  }
  // In a whole file they are a part of the points where there is no room for them.
  const bool is_whole = room(*size, header) >= header.count;
  header.offset_to_points += sizeof(kStart);
  if (is_whole && room(*size, header) < header.count) {
    header.offset_to_points -= sizeof(kStart);
  } else {
    source.skip(sizeof(kStart));
  }
}

[[noreturn]] void fail_truncated(const InputBytes& source, std::uint64_t size,
                                 const LasHeader& header, const std::string& doubt) {
  throw BadInput(source.name(),
                 fmt::format("the header says {} points of {} bytes, but the file ends at byte {}, "
                             "after {} of them{}; get a complete copy",
                             header.count, header.record_length, size, room(size, header), doubt),
                 at_byte(size), Remedy::kSalvage);
}

/// Makes the header count the points that are there.
void count_what_is_left(std::uint64_t size, LasHeader& header) {
  const std::uint64_t told = header.count;
  header.count = room(size, header);
  header.lost = told - header.count;
  header.notices.push_back(
      fmt::format("the file ends at byte {}, after {} of {} points: {} are lost", size,
                  header.count, told, header.lost));
}

/// Whether what follows the points from `begin` to `end` is padding, by its first bytes.
bool begins_as_padding(InputBytes& source, std::uint64_t begin, std::uint64_t end) {
  constexpr std::uint64_t kLooksAt = std::uint64_t{1} << 16;
  const std::uint64_t back = source.position();
  if (!source.seek(begin)) return false;
  const bool padding = is_padding(source.peek(std::min(end - begin, kLooksAt)));
  source.seek(back);
  return padding;
}

/// Finds out what follows the points that the header counts, where there is room for more of them.
void look_for_more(InputBytes& source, std::uint64_t size, LasHeader& header, bool salvage) {
  const std::uint64_t end = std::min(size, header.offset_behind_points.value_or(size));
  const std::uint64_t told = header.offset_to_points + header.count * header.record_length;
  if (end < told + header.record_length || begins_as_padding(source, told, end)) return;
  const std::uint64_t more = (end - told) / header.record_length;
  if (!salvage) {
    header.notices.push_back(fmt::format(
        "the header counts {} points, but {} bytes follow them, room for {} more, which are not "
        "read; if they are points, correct the count in the header ({}), or salvage them",
        header.count, end - told, more, place_of_count(header)));
    return;
  }
  header.notices.push_back(
      fmt::format("the header counts {} points, but {} bytes follow them: {} more points are read",
                  header.count, end - told, more));
  header.count += more;
  header.extent = {};  // may be of those that the header counts
}

}  // namespace

void find_points(InputBytes& source, LasHeader& header, const PointSearch& search) {
  skip_start_signature(source, header);
  const std::optional<std::uint64_t> size = source.size();
  if (!size) return;
  if (header.count <= room(*size, header)) {
    look_for_more(source, *size, header, search.salvage);
  } else if (search.salvage) {
    count_what_is_left(*size, header);
  } else {
    fail_truncated(source, *size, header, search.doubt);
  }
}

bool is_padding(std::span<const std::byte> bytes) {
  return std::ranges::all_of(bytes, [](std::byte byte) { return byte == std::byte{0}; });
}

std::string place_of_count(const LasHeader& las) {
  return las.version == "1.4" || las.version == "1.5"
             ? fmt::format("8 bytes from byte {} on", las_field::kCount)
             : fmt::format("4 bytes from byte {} on", las_field::kLegacyCount);
}

}  // namespace spillway::formats
