#include "src/delaunay/common/triangulation.h"

#include "src/geometry/dimensions.h"

namespace spillway::delaunay {

template <int D>
std::size_t Triangulation<D>::finite_count() const {
  std::size_t all = 0;
  for_each_simplex([&](SimplexId, const Simplex<D>&) { ++all; });
  return all - hull.size();
}

#define SPILLWAY_INSTANTIATE(D) template std::size_t Triangulation<D>::finite_count() const;
SPILLWAY_FOR_EACH_DIMENSION(SPILLWAY_INSTANTIATE)
#undef SPILLWAY_INSTANTIATE

}  // namespace spillway::delaunay
