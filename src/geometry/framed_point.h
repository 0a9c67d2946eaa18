#pragma once
// Points with the coordinates they are in, told apart by their types. Each can be read as three
// numbers, but none becomes one of the others: what maps them is in lattice.h.

#include "src/geometry/point.h"

namespace spillway::geometry {

/// Three numbers in the coordinates that Frame stands for. Nothing but the type tells it from a
/// Point<3>, which becomes one only where that is said.
template <typename Frame>
struct FramedPoint : Point<3> {
  FramedPoint() = default;
  constexpr FramedPoint(double x, double y, double z) : Point<3>{x, y, z} {}
  constexpr explicit FramedPoint(const Point<3>& numbers) : Point<3>(numbers) {}
  template <typename Other>
  FramedPoint(const FramedPoint<Other>&) = delete;

  /// The numbers alone, to be taken for whatever the caller knows them to be.
  [[nodiscard]] constexpr const Point<3>& numbers() const { return *this; }
};

/// Points of different coordinates are not compared.
template <typename Frame, typename Other>
bool operator==(const FramedPoint<Frame>&, const FramedPoint<Other>&) = delete;
template <typename Frame>
constexpr bool operator==(const FramedPoint<Frame>& a, const FramedPoint<Frame>& b) {
  return a.numbers() == b.numbers();
}

/// As its source or stream gives it: integers of the lattice that this has (in the plane z may lie
/// between them); output coordinates if it has none.
using LatticePoint = FramedPoint<struct LatticeFrame>;

/// In output coordinates.
using WorldPoint = FramedPoint<struct WorldFrame>;

/// A point of a terrain as rasters are painted: x and y on the lattice, if there is one, z in
/// output units.
using PlacedPoint = FramedPoint<struct PlacedFrame>;

}  // namespace spillway::geometry
