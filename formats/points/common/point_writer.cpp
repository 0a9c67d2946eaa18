#include "formats/points/common/point_writer.h"

#include <fmt/format.h>

#include "src/error.h"

namespace spillway::detail {

void check_written(const OutputFile& file, std::optional<std::uint64_t> promised,
                   std::uint64_t written) {
  if (promised && written != *promised) {
    throw Error(fmt::format("cannot write {}: {} points were promised, but {} came", file.name(),
                            *promised, written));
  }
}

}  // namespace spillway::detail
