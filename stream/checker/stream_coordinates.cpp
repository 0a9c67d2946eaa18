#include "stream/checker/stream_coordinates.h"

#include <algorithm>
#include <cmath>

#include "src/geometry/dimensions.h"

namespace spillway::checker {
namespace {

/// With coordinates beyond z, which are on no lattice, none are.
template <int D>
std::optional<IntegerLattice> lattice_of(const MeshStreamHeader& header,
                                         const std::optional<IntegerLattice>& input_lattice) {
  if (D > kOwnAxes) return std::nullopt;
  return header.lattice ? header.lattice : input_lattice;
}

}  // namespace

template <int D>
StreamCoordinates<D>::StreamCoordinates(const MeshStreamHeader& header,
                                        const std::optional<IntegerLattice>& input_lattice)
    : lattice_(lattice_of<D>(header, input_lattice)),
      blocks_hold_integers_(lattice_ && header.lattice),
      on_lattice_(lattice_ && lattice_->isotropic(D)) {
  if (!header.periodic) return;
  if (on_lattice_) {
    torus_.emplace(*header.periodic, D, *lattice_);
  } else {
    torus_.emplace(*header.periodic, D);
  }
}

template <int D>
int StreamCoordinates<D>::axis_off_lattice(const LatticePoint& in_block) const {
  if (!lattice_) return -1;
  for (int k = 0; k < D; ++k) {
    const bool is_on = blocks_hold_integers_ ? in_block[k] == std::trunc(in_block[k])
                                             : lattice_->to_integer(k, in_block[k]).has_value();
    if (!is_on) return k;
  }
  return -1;
}

template <int D>
Point<D> StreamCoordinates<D>::for_predicates(Point<D> point) const {
  if (blocks_hold_integers_ == on_lattice_) return point;
  for (int k = 0; k < D; ++k) {
    if (blocks_hold_integers_) {
      point[k] = lattice_->to_world(k, point[k]);
    } else {
      const double nearest = std::round((point[k] - lattice_->offset[k]) / lattice_->scale[k]);
      point[k] = lattice_->to_integer(k, point[k]).value_or(nearest);
    }
  }
  return point;
}

template <int D>
Point<D> StreamCoordinates<D>::to_output(const Point<D>& point) const {
  if (!on_lattice_) return point;
  Point<D> result;
  for (int k = 0; k < D; ++k) result[k] = lattice_->to_world(k, point[k]);
  return result;
}

#define SPILLWAY_INSTANTIATE(D) template class StreamCoordinates<D>;
SPILLWAY_FOR_EACH_DIMENSION(SPILLWAY_INSTANTIATE)
#undef SPILLWAY_INSTANTIATE

}  // namespace spillway::checker
