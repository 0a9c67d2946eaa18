#include "stream/library/points/public_points.h"

namespace spillway::detail {

std::vector<Point<3>> public_points(const std::optional<Lattice>& lattice,
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

}  // namespace spillway::detail
