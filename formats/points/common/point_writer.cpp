#include "formats/points/common/point_writer.h"

#include <fmt/format.h>

#include "src/error.h"

namespace spillway::formats {

void share(const WorkSharing& sharing, std::size_t count, const WorkSharing::Body& body) {
  if (sharing.run) {
    sharing.run(count, body);
  } else {
    for (std::size_t i = 0; i < count; ++i) body(i);
  }
}

void PointWriter::set_regions(std::span<const PointRegion> /*regions*/) {
  throw InvalidArgument("this format of points has no regions");
}

void check_written(const OutputFile& file, std::optional<std::uint64_t> promised,
                   std::uint64_t written) {
  if (promised && written != *promised) {
    throw CannotWrite(file.name(),
                      fmt::format("{} points were promised, but {} came", *promised, written));
  }
}

}  // namespace spillway::formats
