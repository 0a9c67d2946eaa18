#include "stream/library/tiling/vector_tiling.h"

#include "stream/library/tiling/square_names.h"
#include "stream/library/tiling/vector_polygons.h"
#include "stream/library/tiling/vector_squares.h"

namespace spillway::stream {

std::unique_ptr<VectorTiling> make_vector_tiling(const std::string& pattern, double side,
                                                 const std::string& polygons) {
  refuse_two_kinds(side, polygons);
  if (side != 0) return std::make_unique<VectorSquares>(pattern, side);
  if (!polygons.empty()) return std::make_unique<VectorPolygons>(pattern, polygons);
  return nullptr;
}

}  // namespace spillway::stream
