#include "stream/library/tiling/mesh_tiling.h"

#include <fmt/format.h>

#include <set>

#include "src/error.h"

namespace spillway::stream {

std::vector<std::string> MeshTiling::paths(std::span<const std::size_t> tiles) const {
  std::vector<std::string> paths;
  std::set<std::string> seen;
  for (const std::size_t tile : tiles) {
    const auto [name, is_new] = seen.insert(path(tile));
    if (!is_new) {
      throw InvalidArgument(fmt::format("two tiles would both be {}: choose a larger side", *name),
                            {.file = *name});
    }
    paths.push_back(*name);
  }
  return paths;
}

}  // namespace spillway::stream
