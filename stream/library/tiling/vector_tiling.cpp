#include "stream/library/tiling/vector_tiling.h"

#include <fmt/format.h>

#include <set>

#include "src/error.h"
#include "stream/library/tiling/square_names.h"
#include "stream/library/tiling/vector_polygons.h"
#include "stream/library/tiling/vector_squares.h"

namespace spillway::stream {

std::vector<std::string> VectorTiling::paths(std::span<const std::size_t> tiles) const {
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

std::unique_ptr<VectorTiling> make_vector_tiling(const std::string& pattern, double side,
                                                 const std::string& polygons) {
  refuse_two_kinds(side, polygons);
  if (side != 0) return std::make_unique<VectorSquares>(pattern, side);
  if (!polygons.empty()) return std::make_unique<VectorPolygons>(pattern, polygons);
  return nullptr;
}

}  // namespace spillway::stream
