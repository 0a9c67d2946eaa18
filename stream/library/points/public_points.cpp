#include "stream/library/points/public_points.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "src/error.h"
#include "src/geometry/dimensions.h"

namespace spillway::stream {

std::vector<Point<3>> public_points(const std::optional<IntegerLattice>& lattice,
                                    std::span<const LatticePoint> points) {
  std::vector<Point<3>> told;
  told.reserve(points.size());
  for (const LatticePoint& point : points) told.push_back(in_world(lattice, point));
  return told;
}

std::vector<LatticePoint> points_without_lattice(std::span<const Point<3>> points) {
  std::vector<LatticePoint> taken;
  taken.reserve(points.size());
  for (const Point<3>& point : points) taken.emplace_back(point);
  return taken;
}

template <int D>
const Point<D>& finite_point(const Point<D>& point, std::uint64_t number) {
  if (std::ranges::all_of(point, [](double x) { return std::isfinite(x); })) return point;
  throw InvalidArgument(fmt::format("point {} has a coordinate that is not finite: ({})", number,
                                    fmt::join(point, ", ")));
}

std::optional<Lattice> public_lattice(const std::optional<IntegerLattice>& lattice, bool has_z) {
  if (!lattice) return std::nullopt;
  return Lattice{lattice->scale, lattice->offset, has_z};
}

std::optional<IntegerLattice> checked_lattice(const std::optional<Lattice>& lattice) {
  if (!lattice) return std::nullopt;
  for (int axis = 0; axis < 3; ++axis) {
    const double scale = lattice->scale[axis];
    const double offset = lattice->offset[axis];
    if (std::isfinite(scale) && scale != 0 && std::isfinite(offset)) continue;
    throw InvalidArgument(
        fmt::format("no lattice has the scale {} and the offset {}, as that of {}", scale, offset,
                    "xyz"[axis]));
  }
  if (!lattice->has_z && (lattice->scale[2] != 1 || lattice->offset[2] != 0)) {
    throw InvalidArgument("a lattice without z has 1 as the scale of z and 0 as its offset");
  }
  return IntegerLattice{lattice->scale, lattice->offset};
}

double integer_on(const IntegerLattice& lattice, int axis, double coordinate, const char* what,
                  std::uint64_t number) {
  const std::optional<double> integer = lattice.to_integer(axis, coordinate);
  if (integer) return *integer;
  throw InvalidArgument(fmt::format(
      "{} of {} {} is {}, which is not on the lattice of scale {} and offset {} that the "
      "header tells: leave that out, or round",
      "xyz"[axis], what, number, coordinate, lattice.scale[axis], lattice.offset[axis]));
}

std::optional<Box<3>> told_box(const std::optional<Extent>& extent, const char* what) {
  if (!extent) return std::nullopt;
  for (int axis = 0; axis < 3; ++axis) {
    const double low = extent->low[axis];
    const double high = extent->high[axis];
    if (!std::isfinite(low) || !std::isfinite(high)) {
      throw InvalidArgument(
          fmt::format("the header of {} tells an extent that is not finite", what));
    }
    if (low > high) {
      throw InvalidArgument(fmt::format("the header of {} tells an extent from {} to {} in {}",
                                        what, low, high, "xyz"[axis]));
    }
  }
  return Box<3>{extent->low, extent->high};
}

#define SPILLWAY_INSTANTIATE(D) \
  template const Point<D>& finite_point<D>(const Point<D>&, std::uint64_t);
SPILLWAY_FOR_EACH_DIMENSION(SPILLWAY_INSTANTIATE)
#undef SPILLWAY_INSTANTIATE

std::optional<Box<3>> checked_box(const PointsHeader& header) {
  if (header.coordinates != 2 && header.coordinates != 3) {
    throw InvalidArgument(
        fmt::format("points have 2 or 3 coordinates, not {}", header.coordinates));
  }
  return told_box(header.extent, "points");
}

}  // namespace spillway::stream
