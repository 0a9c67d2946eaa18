#include "src/delaunay/common/triangulation.h"

namespace spillway::delaunay {

template <int D>
std::size_t Triangulation<D>::finite_count() const {
  std::size_t all = 0;
  for_each_simplex([&](SimplexId, const Simplex<D>&) { ++all; });
  return all - hull.size();
}

template std::size_t Triangulation<2>::finite_count() const;
template std::size_t Triangulation<3>::finite_count() const;

}  // namespace spillway::delaunay
