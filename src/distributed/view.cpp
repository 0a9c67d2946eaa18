#include "src/distributed/view.h"

#include <algorithm>

namespace spillway::detail::distributed {

template <int D>
VertexId View<D>::beyond(const Simplex<D>& simplex, int i) const {
  const std::uint32_t n = simplex.neighbours[i];
  if (n == kInfiniteElsewhere) return kInfiniteVertex;
  if (n >= Simplex<D>::kLink) return n - Simplex<D>::kLink;
  const auto& corners = simplices[n].vertices;
  return *std::find_if(corners.begin(), corners.end(), [&](VertexId v) {
    return std::find(simplex.vertices.begin(), simplex.vertices.end(), v) == simplex.vertices.end();
  });
}

template VertexId View<2>::beyond(const Simplex<2>&, int) const;
template VertexId View<3>::beyond(const Simplex<3>&, int) const;

}  // namespace spillway::detail::distributed
